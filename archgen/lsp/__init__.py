"""The language server: what an editor asks over the protocol, answered from a warm project."""
