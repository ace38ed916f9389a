"""Turns merged YAML into the elements of both levels, one module for each part of the language."""
