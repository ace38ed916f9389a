"""The document that a report is written into: archgen's own template, or a partner's with its styles, cover, headers and paper.

What stands in a partner's template comes before the report as its cover, up to a paragraph `{{report}}` if there is one; what stands behind
that paragraph closes the document. Names in double braces ({{title}}, {{subtitle}} and the lines of the title page, such as
{{version}}) are filled in, in headers and footers too.
"""

from __future__ import annotations

import posixpath
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from lxml import etree

from archgen import resources
from archgen.emit.docx.markup import NAMESPACES, clean
from archgen.emit.docx.package import Package, Relation, TemplateError, parse, unpack, unpacked, xml_bytes
from archgen.emit.docx.styles import tag

_MAIN = "application/vnd.openxmlformats-officedocument.wordprocessingml.document.main+xml"
_TEMPLATE = "application/vnd.openxmlformats-officedocument.wordprocessingml.template.main+xml"
_MACROS = ("macroEnabled", "vbaProject", "vbaData", "activeX")
_STRICT = "http://purl.oclc.org/ooxml/wordprocessingml/main"
_NAME = re.compile(r"\{\{\s*([^{}]{1,80}?)\s*\}\}")
_SEES = ("t", "drawing", "pict", "object", "sym", "fldSimple", "instrText", "sdt", "tbl")
_HERE = "{{report}}"
_UNWANTED = ("updateFields", "attachedTemplate", "mailMerge", "documentProtection", "writeProtection")
"""Settings that make Word ask a question, fetch something, or lock the report."""


@dataclass(slots=True)
class Template:
    """An opened template. `before` and `after` are what stands in it around the report, `section` its last paper."""

    package: Package
    main: str
    root: etree._Element
    relations: list[Relation]
    before: tuple[etree._Element, ...]
    after: tuple[etree._Element, ...]
    section: etree._Element | None

    @property
    def folder(self) -> str:
        """Give the main part's folder, with a slash at its end if it has one."""
        folder = posixpath.dirname(self.main)
        return folder + "/" if folder else ""

    def part(self, kind: str) -> str | None:
        """Give the name of the part that the document uses for something (styles, numbering, settings)."""
        names = (item.target for item in self.relations if item.kind == kind and not item.external)
        return next((name for name in names if name in self.package.parts), None)

    def tree(self, kind: str) -> etree._Element | None:
        """Give such a part, parsed."""
        name = self.part(kind)
        if name is None:
            return None
        root = parse(self.package.parts[name], name)
        return root if root.tag == tag(kind) else None

    def replace(self, kind: str, root: etree._Element, relation: str) -> None:
        """Write such a part, with a relationship to it if the document had none."""
        name = self.part(kind)
        if name is None:
            name = f"{self.folder}archgen-{kind}.xml"
            self.relations.append(Relation(f"agPart{kind}", relation, name))
        content_type = f"application/vnd.openxmlformats-officedocument.wordprocessingml.{kind}+xml"
        self.package.add(name, xml_bytes(root), content_type)


def opened(data: bytes | None) -> Template:
    """Open a partner's template, or archgen's own for None."""
    package = unpacked(resources.resource_path("backends", "report", "template")) if data is None else unpack(data)
    main = _main_part(package)
    root = parse(package.parts[main], main)
    if root.tag == f"{{{_STRICT}}}document":
        message = 'the template is a "Strict Open XML Document": save it as an ordinary Word document (.docx)'
        raise TemplateError(message)
    body = root.find(tag("body"))
    if root.tag != tag("document") or body is None:
        message = f"the template is no Word file: its part `{main}` holds no document"
        raise TemplateError(message)
    package.types[main] = _MAIN
    section = body.find(tag("sectPr"))
    if section is not None:
        body.remove(section)
    before, after = _around(list(body))
    return Template(package, main, root, _usable(package, main), before, after, section)


def own_styles() -> etree._Element:
    """Give the styles of archgen's own template."""
    path = resources.resource_path("backends", "report", "template", "word", "styles.xml")
    return parse(path.read_bytes(), path.name)


def fill(template: Template, values: Mapping[str, str]) -> tuple[str, ...]:
    """Put the report's values where names stand in double braces. Gives the names that the report has no value for."""
    unknown: set[str] = set()
    for element in (*template.before, *template.after):
        _fill(element, values, unknown)
    for relation in template.relations:
        if relation.kind in {"header", "footer"} and relation.target in template.package.parts:
            root = parse(template.package.parts[relation.target], relation.target)
            _fill(root, values, unknown)
            template.package.parts[relation.target] = xml_bytes(root)
    return tuple(sorted(unknown))


def names_in(elements: Sequence[etree._Element]) -> frozenset[str]:
    """Give the names in double braces that stand in some elements."""
    text = "\n".join(
        "".join(item.text or "" for item in paragraph.iter(tag("t")))
        for element in elements
        for paragraph in element.iter(tag("p"))
    )
    return frozenset(match.casefold() for match in _NAME.findall(text))


def settings(template: Template) -> etree._Element:
    """Give the document's settings without what asks questions, fetches or locks."""
    root = template.tree("settings")
    root = etree.Element(tag("settings"), nsmap={"w": NAMESPACES["w"]}) if root is None else root
    for name in _UNWANTED:
        for item in root.findall(tag(name)):
            root.remove(item)
    part = template.part("settings")
    if part:
        kept = [
            item
            for item in template.package.relations(part)
            if item.kind not in {"attachedTemplate", "mailMergeSource", "mailMergeHeaderSource"}
        ]
        template.package.relate(part, kept)
    return root


def _main_part(package: Package) -> str:
    if any(sign in content for content in [*package.types.values(), *package.endings.values()] for sign in _MACROS):
        message = "the template is refused: it holds macros or controls; save it as .docx or .dotx without them"
        raise TemplateError(message)
    main = next((item.target for item in package.relations("") if item.kind == "officeDocument"), "")
    if main not in package.parts or package.type_of(main) not in {_MAIN, _TEMPLATE}:
        message = "the template is no Word file: its main part is not a Word document (.docx) or template (.dotx)"
        raise TemplateError(message)
    return main


def _usable(package: Package, main: str) -> list[Relation]:
    """Give the document's relationships that lead somewhere, each id once."""
    found: dict[str, Relation] = {}
    for relation in package.relations(main):
        if relation.id and (relation.external or relation.target in package.parts):
            found.setdefault(relation.id, relation)
    return list(found.values())


def _around(children: list[etree._Element]) -> tuple[tuple[etree._Element, ...], tuple[etree._Element, ...]]:
    """Split a template's body at the paragraph that says where the report goes. A body that shows nothing is no cover."""
    if not any(item.tag in {tag(name) for name in _SEES} for child in children for item in child.iter()):
        return (), ()
    for index, child in enumerate(children):
        if (
            child.tag == tag("p")
            and "".join(item.text or "" for item in child.iter(tag("t"))).strip().casefold() == _HERE
        ):
            return tuple(children[:index]), tuple(children[index + 1 :])
    return tuple(children), ()


def _fill(root: etree._Element, values: Mapping[str, str], unknown: set[str]) -> None:
    for paragraph in root.iter(tag("p")):
        texts = [item for item in paragraph.iter(tag("t")) if next(item.iterancestors(tag("p")), None) is paragraph]
        whole = "".join(item.text or "" for item in texts)
        if "{{" not in whole or not _NAME.search(whole):
            continue
        unknown.update(name for name in _NAME.findall(whole) if name.casefold() not in values)
        # Word cuts a name into several runs as it pleases: then the paragraph's text goes into the first.
        if all(_NAME.sub("", item.text or "").count("{{") == 0 for item in texts):
            for item in texts:
                _write(item, _filled(item.text or "", values))
        else:
            _write(texts[0], _filled(whole, values))
            for item in texts[1:]:
                item.text = ""


def _filled(text: str, values: Mapping[str, str]) -> str:
    return _NAME.sub(lambda match: clean(values.get(match[1].casefold(), "")), text)


def _write(item: etree._Element, text: str) -> None:
    item.text = text
    item.set("{http://www.w3.org/XML/1998/namespace}space", "preserve")
