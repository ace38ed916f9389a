"""What the model leaves out is derived before it is judged and shown: topics, planned nodes. Architecture in, architecture out."""

from archgen.derivation.low_level import derive_low_level

__all__ = ["derive_low_level"]
