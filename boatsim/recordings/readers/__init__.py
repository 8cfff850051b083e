"""One format a file: `read(path) -> Raw`, found by the suffix of the recording."""
