"""What a document says about itself: its title and language. No clock and no name of a machine, so the same report is the same bytes."""

from __future__ import annotations

from archgen.emit.docx.markup import escape
from archgen.emit.docx.package import Package, Relation
from archgen.views.shapes import Outline

_CORE = "docProps/core.xml"
_CORE_TYPE = "application/vnd.openxmlformats-package.core-properties+xml"
_CORE_RELATION = "http://schemas.openxmlformats.org/package/2006/relationships/metadata/core-properties"
_KEPT = {"officeDocument", "custom-properties"}
_XML = '<?xml version="1.0" encoding="UTF-8" standalone="yes"?>\n'


def describe(package: Package, outline: Outline, version: str = "") -> None:
    """Put the report's own properties in the place of the template's; custom ones, which covers may show, stay."""
    kept = []
    for relation in package.relations(""):
        if relation.kind in _KEPT and relation.target in package.parts:
            kept.append(relation)
        elif not relation.external:
            package.remove(relation.target)
    core = (
        f'{_XML}<cp:coreProperties xmlns:cp="http://schemas.openxmlformats.org/package/2006/metadata/core-properties" '
        'xmlns:dc="http://purl.org/dc/elements/1.1/">'
        f"<dc:title>{escape(outline.title)}</dc:title><dc:subject>{escape(outline.subtitle)}</dc:subject>"
        f"<dc:language>{escape(outline.language)}</dc:language><cp:version>{escape(version)}</cp:version></cp:coreProperties>"
    )
    package.add(_CORE, core.encode(), _CORE_TYPE)
    ids = {relation.id for relation in kept}
    free = next(f"rId{n}" for n in range(1, len(ids) + 2) if f"rId{n}" not in ids)
    package.relate("", [*kept, Relation(free, _CORE_RELATION, _CORE)])
