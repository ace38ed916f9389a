"""AADL v2.2, textual: tokens, parser, name resolution, and what of a model becomes slices of the language."""
