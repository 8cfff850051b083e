"""File formats of recordings, one module per format with `read(path) -> Raw`, named by the suffix of the file."""
