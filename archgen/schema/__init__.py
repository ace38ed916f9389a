"""Schema: check a document against the JSON Schema, phrase what is wrong, and expand the short forms."""

from archgen.schema.rules import RULES
from archgen.schema.shorthand import fold, normalise
from archgen.schema.validate import sections, validate
from archgen.schema.wording import better_keys, element

__all__ = ["RULES", "better_keys", "element", "fold", "normalise", "sections", "validate"]
