"""The language: its kinds and keys as tables, made from the description in `language/`."""
