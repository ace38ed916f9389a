"""Write a ReqIF 1.2 file: the same requirements give the same bytes, with ids that stay from one export to the next."""

from __future__ import annotations

import hashlib
import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from xml.sax.saxutils import escape

from archgen.views.requirement_exchange import ExchangedRequirement, RequirementExchange

_TIME = "2000-01-01T00:00:00Z"
"""The time of all that has one: ReqIF asks for it, and a file made twice must be the same."""
_CHANGE = f'LAST-CHANGE="{_TIME}"'
_TEXTS = ("ReqIF.Text", "Rationale")
_LINES = ("ReqIF.ForeignID", "ReqIF.Name", "Source", "Tags", "Served by", "State")
_WORDS = ("Kind", "Priority")


def render_reqif(exchange: RequirementExchange) -> bytes:
    """Return requirements as a ReqIF file in UTF-8."""
    return "".join(f"{line}\n" for line in _list_lines(exchange)).encode("utf-8")


def _list_lines(exchange: RequirementExchange) -> Iterator[str]:
    yield '<?xml version="1.0" encoding="UTF-8"?>'
    yield '<REQ-IF xmlns="http://www.omg.org/spec/ReqIF/20110401/reqif.xsd" xmlns:xhtml="http://www.w3.org/1999/xhtml">'
    yield f'<THE-HEADER><REQ-IF-HEADER IDENTIFIER="header-{exchange.project_id}">'
    yield f"<CREATION-TIME>{_TIME}</CREATION-TIME>"
    yield "<REQ-IF-TOOL-ID>archgen</REQ-IF-TOOL-ID><REQ-IF-VERSION>1.0</REQ-IF-VERSION>"
    yield f"<SOURCE-TOOL-ID>archgen</SOURCE-TOOL-ID><TITLE>{make_attribute(exchange.title)}</TITLE>"
    yield "</REQ-IF-HEADER></THE-HEADER>"
    yield "<CORE-CONTENT><REQ-IF-CONTENT>"
    yield from _list_datatypes(exchange)
    yield from _list_types()
    identifiers = assign_identifiers(exchange.requirements)
    yield from _list_objects(exchange, identifiers)
    yield from _list_relations(exchange, identifiers)
    yield from _list_specification(exchange, identifiers)
    yield "</REQ-IF-CONTENT></CORE-CONTENT>"
    yield "</REQ-IF>"


def _list_datatypes(exchange: RequirementExchange) -> Iterator[str]:
    yield "<DATATYPES>"
    yield f'<DATATYPE-DEFINITION-STRING IDENTIFIER="datatype-line" {_CHANGE} LONG-NAME="Line" MAX-LENGTH="32000"/>'
    yield f'<DATATYPE-DEFINITION-XHTML IDENTIFIER="datatype-text" {_CHANGE} LONG-NAME="Text"/>'
    for name, words in (("Kind", _list_words(exchange, "kind")), ("Priority", _list_words(exchange, "priority"))):
        yield f'<DATATYPE-DEFINITION-ENUMERATION IDENTIFIER="datatype-{name}" {_CHANGE} LONG-NAME="{name}">'
        yield "<SPECIFIED-VALUES>"
        for number, word in enumerate(words):
            yield f'<ENUM-VALUE IDENTIFIER="{_word_id(name, word)}" {_CHANGE} LONG-NAME="{make_attribute(word)}">'
            yield f'<PROPERTIES><EMBEDDED-VALUE KEY="{number}" OTHER-CONTENT=""/></PROPERTIES></ENUM-VALUE>'
        yield "</SPECIFIED-VALUES></DATATYPE-DEFINITION-ENUMERATION>"
    yield "</DATATYPES>"


def _list_words(exchange: RequirementExchange, key: str) -> list[str]:
    return sorted({getattr(requirement, key) for requirement in exchange.requirements} - {""})


def _list_types() -> Iterator[str]:
    yield "<SPEC-TYPES>"
    yield f'<SPEC-OBJECT-TYPE IDENTIFIER="type-requirement" {_CHANGE} LONG-NAME="archgen requirement"><SPEC-ATTRIBUTES>'
    yield from (_define_attribute("requirement", name, "STRING", "line") for name in _LINES)
    yield from (_define_attribute("requirement", name, "XHTML", "text") for name in _TEXTS)
    yield from (_define_attribute("requirement", name, "ENUMERATION", name) for name in _WORDS)
    yield "</SPEC-ATTRIBUTES></SPEC-OBJECT-TYPE>"
    for kind in ("use case", "verification"):
        type_id = kind.replace(" ", "-")
        yield f'<SPEC-OBJECT-TYPE IDENTIFIER="type-{type_id}" {_CHANGE} LONG-NAME="archgen {kind}"><SPEC-ATTRIBUTES>'
        yield from (_define_attribute(type_id, name, "STRING", "line") for name in _LINES[:2])
        yield "</SPEC-ATTRIBUTES></SPEC-OBJECT-TYPE>"
    for name in ("part of", "verified by", "use case"):
        type_id = f"relation-{name.replace(' ', '-')}"
        yield f'<SPEC-RELATION-TYPE IDENTIFIER="{type_id}" {_CHANGE} LONG-NAME="archgen {name}"/>'
    yield f'<SPECIFICATION-TYPE IDENTIFIER="type-specification" {_CHANGE} LONG-NAME="archgen specification"/>'
    yield "</SPEC-TYPES>"


def _define_attribute(type_id: str, name: str, sort: str, datatype: str) -> str:
    several = ' MULTI-VALUED="false"' if sort == "ENUMERATION" else ""
    return (
        f'<ATTRIBUTE-DEFINITION-{sort} IDENTIFIER="{_attribute_id(type_id, name)}" {_CHANGE} LONG-NAME="{name}"{several}>'
        f"<TYPE><DATATYPE-DEFINITION-{sort}-REF>datatype-{datatype}</DATATYPE-DEFINITION-{sort}-REF></TYPE>"
        f"</ATTRIBUTE-DEFINITION-{sort}>"
    )


def _attribute_id(type_id: str, name: str) -> str:
    return f"attribute-{type_id}-{name.replace(' ', '-')}"


def _word_id(name: str, word: str) -> str:
    return f"word-{name}-{_shorten_digest(word)}"


def _shorten_digest(text: str) -> str:
    return hashlib.sha256(text.encode("utf-8", "replace")).hexdigest()[:16]


def _list_objects(exchange: RequirementExchange, identifiers: Mapping[str, str]) -> Iterator[str]:
    yield "<SPEC-OBJECTS>"
    for requirement in exchange.requirements:
        yield from _list_requirement(requirement, identifiers[requirement.id])
    for name, title in exchange.use_cases:
        yield from _list_object(f"usecase-{name}", "use-case", {"ReqIF.ForeignID": name, "ReqIF.Name": title})
    verifiers = (each for requirement in exchange.requirements for each in requirement.verified_by)
    for text in dict.fromkeys(text for kind, text in verifiers if kind != "use_case"):
        yield from _list_object(_verifier_id("text", text), "verification", {"ReqIF.Name": text})
    yield "</SPEC-OBJECTS>"


def _verifier_id(kind: str, text: str) -> str:
    return f"usecase-{text}" if kind == "use_case" else f"verification-{_shorten_digest(text)}"


def _list_requirement(requirement: ExchangedRequirement, identifier: str) -> Iterator[str]:
    lines = {
        "ReqIF.ForeignID": requirement.foreign_id or requirement.id,
        "ReqIF.Name": requirement.title,
        "Source": requirement.source,
        "Tags": ", ".join(requirement.tags),
        "Served by": requirement.served_by,
        "State": requirement.state,
    }
    texts = {"ReqIF.Text": requirement.description, "Rationale": requirement.rationale}
    words = {"Kind": requirement.kind, "Priority": requirement.priority}
    yield from _list_object(identifier, "requirement", lines, texts, words)


def _list_object(
    object_id: str,
    type_id: str,
    lines: dict[str, str],
    texts: dict[str, str] | None = None,
    words: dict[str, str] | None = None,
) -> Iterator[str]:
    yield f'<SPEC-OBJECT IDENTIFIER="{object_id}" {_CHANGE}>'
    yield f"<TYPE><SPEC-OBJECT-TYPE-REF>type-{type_id}</SPEC-OBJECT-TYPE-REF></TYPE>"
    yield "<VALUES>"
    for name, text in lines.items():
        if text:
            value = f' THE-VALUE="{make_attribute(text)}"'
            yield _give_value("STRING", type_id, name, value, "")
    for name, text in (texts or {}).items():
        if text.strip():
            yield _give_value("XHTML", type_id, name, "", f"<THE-VALUE>{make_xhtml(text)}</THE-VALUE>")
    for name, word in (words or {}).items():
        if word:
            inner = f"<VALUES><ENUM-VALUE-REF>{_word_id(name, word)}</ENUM-VALUE-REF></VALUES>"
            yield _give_value("ENUMERATION", type_id, name, "", inner)
    yield "</VALUES></SPEC-OBJECT>"


def _give_value(sort: str, type_id: str, name: str, value: str, inner: str) -> str:
    reference = f"ATTRIBUTE-DEFINITION-{sort}-REF"
    definition = f"<DEFINITION><{reference}>{_attribute_id(type_id, name)}</{reference}></DEFINITION>"
    parts = f"{inner}{definition}" if sort == "XHTML" else f"{definition}{inner}"
    return f"<ATTRIBUTE-VALUE-{sort}{value}>{parts}</ATTRIBUTE-VALUE-{sort}>"


def _list_relations(exchange: RequirementExchange, identifiers: Mapping[str, str]) -> Iterator[str]:
    yield "<SPEC-RELATIONS>"
    for requirement in exchange.requirements:
        targets: Iterable[tuple[str, str]] = (
            *(("part-of", identifiers[parent]) for parent in requirement.parents),
            *(("verified-by", _verifier_id(kind, text)) for kind, text in requirement.verified_by),
            *(("use-case", f"usecase-{name}") for name in requirement.use_cases),
        )
        for relation, target in targets:
            relation_id = f"relation-{_shorten_digest(f'{relation} {requirement.id} {target}')}"
            yield f'<SPEC-RELATION IDENTIFIER="{relation_id}" {_CHANGE}>'
            yield f"<TYPE><SPEC-RELATION-TYPE-REF>relation-{relation}</SPEC-RELATION-TYPE-REF></TYPE>"
            yield f"<SOURCE><SPEC-OBJECT-REF>{identifiers[requirement.id]}</SPEC-OBJECT-REF></SOURCE>"
            yield f"<TARGET><SPEC-OBJECT-REF>{target}</SPEC-OBJECT-REF></TARGET></SPEC-RELATION>"
    yield "</SPEC-RELATIONS>"


def _list_specification(exchange: RequirementExchange, identifiers: Mapping[str, str]) -> Iterator[str]:
    """Yield the tree; what is part of several stands below each of them."""
    title = make_attribute(f"Requirements of {exchange.title}")
    yield "<SPECIFICATIONS>"
    yield f'<SPECIFICATION IDENTIFIER="specification-{exchange.project_id}" {_CHANGE} LONG-NAME="{title}">'
    yield "<TYPE><SPECIFICATION-TYPE-REF>type-specification</SPECIFICATION-TYPE-REF></TYPE>"
    yield "<CHILDREN>"
    open_count = 0
    for number, (name, depth) in enumerate(exchange.tree):
        # An entry stays open until one at its depth or above comes: it may have parts.
        while open_count > depth:
            yield "</CHILDREN></SPEC-HIERARCHY>"
            open_count -= 1
        yield f'<SPEC-HIERARCHY IDENTIFIER="place-{number}-{name}" {_CHANGE}>'
        yield f"<OBJECT><SPEC-OBJECT-REF>{identifiers[name]}</SPEC-OBJECT-REF></OBJECT><CHILDREN>"
        open_count += 1
    yield from ["</CHILDREN></SPEC-HIERARCHY>"] * open_count
    yield "</CHILDREN></SPECIFICATION></SPECIFICATIONS>"


_OWN_BEGINNINGS = (
    *("usecase-", "verification-", "datatype-", "type-", "attribute-", "word-", "relation-", "specification-"),
    *("place-", "header-"),
)
"""How the identifiers begin that archgen gives to anything but requirements."""
_IDENTIFIER = re.compile(r"[A-Za-z_][A-Za-z0-9_.-]{0,499}")


def assign_identifiers(requirements: Sequence[ExchangedRequirement]) -> Mapping[str, str]:
    """Return the identifiers of the objects of requirements, by the requirements' ids; no two are the same.

    One of another tool is kept where it can be one, and where nothing else in the file has it.
    """
    own_identifiers = {each.id: f"requirement-{each.id}" for each in requirements}
    used = set(own_identifiers.values())
    identifiers: dict[str, str] = {}
    for each in requirements:
        foreign = each.foreign_identifier
        is_kept = _IDENTIFIER.fullmatch(foreign) and not foreign.startswith(_OWN_BEGINNINGS) and foreign not in used
        identifiers[each.id] = foreign if is_kept else own_identifiers[each.id]
        used.add(identifiers[each.id])
    return identifiers


_NOT_IN_XML = re.compile(r"[^\t\n\r\u0020-\ud7ff\ue000-\ufffd\U00010000-\U0010ffff]")
_NO_BREAK_SPACE = "\u00a0"


def make_attribute(text: str) -> str:
    """Return a text on one line, as the value of an XML attribute in double quotes."""
    return escape(_NOT_IN_XML.sub("\ufffd", " ".join(text.split())), {'"': "&quot;"})


def make_xhtml(text: str) -> str:
    """Return a text as XHTML: a paragraph for each, a break for each line; its signs stay as they are written.

    Blanks that XHTML would fold become no-break spaces, so that lists and code read as they were written.
    """
    plain = _NOT_IN_XML.sub("\ufffd", text.replace("\r\n", "\n").replace("\r", "\n").replace("\t", "    "))
    lines = [line.rstrip() for line in plain.replace(_NO_BREAK_SPACE, " ").split("\n")]
    paragraphs = [part.strip("\n") for part in re.split(r"\n{2,}", "\n".join(lines).strip())]
    blocks = (
        f"<xhtml:p>{'<xhtml:br/>'.join(_keep_blanks(line) for line in part.split(chr(10)))}</xhtml:p>"
        for part in paragraphs
        if part
    )
    return f"<xhtml:div>{''.join(blocks)}</xhtml:div>"


def _keep_blanks(line: str) -> str:
    return escape(re.sub(r"^ +| (?= )", lambda match: _NO_BREAK_SPACE * len(match[0]), line))
