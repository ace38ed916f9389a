"""Transform: architecture in, architecture out."""

from archgen.model.architecture import Architecture


def transform(a: Architecture) -> Architecture:
    """Stub until derive lands."""
    return a
