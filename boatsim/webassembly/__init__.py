"""A vessel's program as WebAssembly, which a page runs in a browser without a server."""
