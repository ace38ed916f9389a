"""Schema: check a document against the JSON Schema, phrase what is wrong, and expand the short forms."""

from archgen.schema.schema_validation import list_sections, validate_document
from archgen.schema.short_forms import fold_type_name, normalise_document

__all__ = ["fold_type_name", "list_sections", "normalise_document", "validate_document"]
