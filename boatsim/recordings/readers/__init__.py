"""File formats of recordings: modules with `read(path) -> Raw`, named by the suffix."""
