"""Schema: what may stand where, in our own words; short forms are taken out here."""

from archgen.schema.rules import RULES
from archgen.schema.shorthand import fold, normalise
from archgen.schema.validate import sections, validate
from archgen.schema.wording import better_keys, element

__all__ = ["RULES", "better_keys", "element", "fold", "normalise", "sections", "validate"]
