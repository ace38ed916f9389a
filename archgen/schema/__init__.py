"""Schema: what may stand where, in our own words; short forms are taken out here."""

from archgen.schema.rules import RULES
from archgen.schema.shorthand import fold, normalise
from archgen.schema.validate import sections, validate

__all__ = ["RULES", "fold", "normalise", "sections", "validate"]
