"""`archgen import` of ReqIF: the requirements of a file, with those of the project that came from it before found again.

Take the requirements out of a ReqIF document; each of its objects is accounted for.

Ids for the objects of a ReqIF file: the same object gets the same id in each import.

The requirements that earlier imports brought, found again by what the other tool calls them: it stands in their hints.

What the attributes of ReqIF files mean, by the names that Doors, Polarion and others give them.
"""

from __future__ import annotations

import hashlib
import re
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, field
from functools import lru_cache
from pathlib import Path
from typing import Any, Literal

from archgen.plugin.importing import MAX_ID_LENGTH, ImportedRequirements, ObjectAccount, needs_quotes, spell_in_ascii
from archgen.plugin.model import Requirement
from archgen.plugins.reqif.reqif_files import ReqifDocument, ReqifObject, read_reqif_file

_NAMES_BY_MEANING: Mapping[str, tuple[str, ...]] = {
    "id": ("foreignid", "objectidentifier", "identifier", "id", "reqid", "requirementid"),
    "prefix": ("prefix", "idprefix"),
    "deleted": ("foreigndeleted",),
    "name": ("name", "title", "objectshorttext", "summary", "shorttext"),
    "text": ("text", "objecttext", "primarytext"),
    "description": ("description",),
    "heading": ("chaptername", "objectheading", "heading"),
    "sort": ("objecttype", "artifacttype", "reqtype", "type"),
    "kind": ("kind", "requirementtype", "requirementkind", "category"),
    "priority": ("priority", "importance"),
    "rationale": ("rationale", "justification"),
    "source": ("source", "origin"),
    "tags": ("tags", "labels"),
}
"""Names without case, blanks and signs, and without `ReqIF.` in front; the first that an object has counts."""
MEANING_BY_NAME = {name: meaning for meaning, names in _NAMES_BY_MEANING.items() for name in names}
_RANKS = {name: rank for names in _NAMES_BY_MEANING.values() for rank, name in enumerate(names)}
HEADING_SORTS = frozenset(
    {"heading", "chapter", "ueberschrift", "überschrift", "information", "info", "folder", "document"}
)
"""What an object of these types says is no requirement."""
PART_RELATIONS = frozenset(
    {
        *("partof", "ispartof", "parent", "hasparent", "childof", "refines", "derives", "derivedfrom", "decomposes"),
        "archgenpartof",
    }
)
"""Relations from a part to what it is part of."""


@lru_cache(4096)
def fold_attribute_name(name: str) -> str:
    """Return a name as names are compared: `ReqIF.ForeignID` is `foreignid`."""
    folded = "".join(letter for letter in name.casefold() if letter.isalnum())
    return folded.removeprefix("reqif") or folded


@dataclass(frozen=True, slots=True)
class ReadMeanings:
    """An object's values by what they mean; those of an enumeration with several values one by one; other attributes."""

    values: dict[str, str]
    chosen: dict[str, list[str]]
    unknown_names: list[str]


def read_meanings(document: ReqifDocument, entry: ReqifObject) -> ReadMeanings:
    """Return what an object's attributes mean."""
    values: dict[str, tuple[int, str]] = {}
    chosen: dict[str, list[str]] = {}
    unknown_names: list[str] = []
    choices = {key: [document.names.get(each, each) for each in ids] for key, ids in entry.choices.items()}
    texts = {key: ", ".join(words) for key, words in choices.items()}
    for definition, text in (*entry.values.items(), *texts.items()):
        name = document.names.get(definition, "")
        folded = fold_attribute_name(name)
        meaning = MEANING_BY_NAME.get(folded)
        if meaning is None:
            unknown_names.append(name or definition)
        elif meaning not in values or _RANKS[folded] < values[meaning][0]:
            # A blank at the end of a prefix stands between it and the number.
            values[meaning] = (_RANKS[folded], text if meaning == "prefix" else text.strip())
            chosen[meaning] = choices.get(definition, [])
    found_values = {meaning: text for meaning, (_, text) in values.items()}
    return ReadMeanings(found_values, {key: words for key, words in chosen.items() if words}, unknown_names)


HINTS_KEY = "reqif"


@dataclass(frozen=True, slots=True)
class KnownRequirements:
    """Ids of requirements by the identifiers of their objects, and by the ids of the other tool as it writes them."""

    by_identifier: Mapping[str, str] = field(default_factory=dict)
    by_foreign_id: Mapping[str, str] = field(default_factory=dict)

    def find(self, identifier: str, foreign_id: str) -> str | None:
        """Return the requirement of an object: its identifier stays the same when somebody numbers anew in the other tool."""
        return self.by_identifier.get(identifier) or self.by_foreign_id.get(foreign_id)


def find_known_requirements(requirements: Iterable[Requirement]) -> KnownRequirements:
    """Return what the hints of requirements say of other tools."""
    by_identifier: dict[str, str] = {}
    by_foreign_id: dict[str, str] = {}
    for requirement in requirements:
        hints = requirement.annotations.hints.get(HINTS_KEY)
        if not isinstance(hints, Mapping):
            continue
        for key, ids in (("identifier", by_identifier), ("id", by_foreign_id)):
            # Whoever writes `id: 12` by hand means the text.
            if (name := hints.get(key)) not in {None, ""}:
                ids.setdefault(str(name), requirement.id)
    return KnownRequirements(by_identifier, by_foreign_id)


def make_identity_hints(identifier: str, foreign_id: str, made_id: str) -> dict[str, dict[str, str]]:
    """Return the hints by which the next import finds a requirement, whatever it is called by then."""
    named = {"identifier": identifier, "id": foreign_id if foreign_id != made_id else ""}
    return {HINTS_KEY: {key: text for key, text in named.items() if text}}


def read_requirements(file: Path, requirements: Iterable[Requirement]) -> ImportedRequirements:
    """Return the requirements of a file; those that the project has keep their ids. Raise ForeignFileError and OSError."""
    return take_requirements(read_reqif_file(file), find_known_requirements(requirements))


OWN_TOOL = "archgen"
REQUIREMENT_TYPE, USE_CASE_TYPE, VERIFICATION_TYPE = "archgen requirement", "archgen use case", "archgen verification"
USE_CASE_RELATION, VERIFICATION_RELATION = "archgen use case", "archgen verified by"
_DERIVED_ATTRIBUTES = frozenset({"Served by", "State"})
"""What archgen itself says of a requirement for others to read: it follows from the project."""
_MAX_TITLE = 160
_PLAIN_SORTS = frozenset({"", "requirement", "req", "anforderung"})
"""Types of objects that say no more than that it is a requirement."""
_SENTENCE_END = re.compile(r"(?<=[.!?])\s")
_MARKS = re.compile(r"\*\*|`")
_WORD_SIGNS = re.compile(r'[\s,:"]+')


def take_requirements(document: ReqifDocument, known: KnownRequirements | None = None) -> ImportedRequirements:
    """Return the requirements of a document, in the order of its specifications; known ones keep their ids."""
    return _RequirementTaker(document, known or KnownRequirements()).take()


class _RequirementTaker:
    def __init__(self, document: ReqifDocument, known: KnownRequirements) -> None:
        self._document, self._known = document, known
        self._result = ImportedRequirements()
        self._id_by_object: dict[str, str] = {}
        self._verifier_by_object: dict[str, str] = {}
        self._headings: dict[str, str] = {}
        """Titles of headings by the object's identifier."""

    def take(self) -> ImportedRequirements:
        for entry in self._order_objects():
            self._take_object(entry)
        for entry in self._document.repeated:
            self._account("not taken", entry, reason="another object has its identifier")
        self._take_relations()
        self._take_hierarchy()
        parents = {name: body["parent"] for name, body in self._result.requirements.items() if "parent" in body}
        self._result.closing_relations = cut_circles(parents)
        for name, _ in self._result.closing_relations:
            if not parents[name]:
                self._result.requirements[name].pop("parent", None)
        for body in self._result.requirements.values():
            body |= {key: list(body[key]) for key in ("parent", "verified_by", "use_cases") if key in body}
        return self._result

    def _order_objects(self) -> list[ReqifObject]:
        """Return the objects as the specifications list them, then the others."""
        objects = self._document.objects
        if self._document.source_tool == OWN_TOOL:
            return list(objects.values())
        ordered = dict.fromkeys(entry.object_id for entry in self._document.entries if entry.object_id in objects)
        return [objects[name] for name in {**ordered, **dict.fromkeys(objects)}]

    def _account(
        self,
        fate: Literal["taken", "left out", "not taken"],
        entry: ReqifObject,
        taken_id: str = "",
        reason: str = "",
        name: str = "",
    ) -> None:
        shown_name = name or entry.long_name or entry.id or "without identifier"
        self._result.accounts.append(ObjectAccount(fate, shown_name, f"{entry.file}:{entry.line}", taken_id, reason))

    def _take_object(self, entry: ReqifObject) -> None:
        type_name = self._document.names.get(entry.type_id, "")
        meanings = read_meanings(self._document, entry)
        values = meanings.values
        name = values.get("id", "")
        if type_name == VERIFICATION_TYPE:
            self._verifier_by_object[entry.id] = _fold_blanks(values.get("name", "") or entry.long_name)
            self._account("taken", entry, reason="as what verifies a requirement", name=name)
        elif type_name == USE_CASE_TYPE and is_requirement_id(name):
            title = _fold_blanks(values.get("name", ""))
            self._result.use_cases[name] = {"title": title} if title and title != name else {}
            self._verifier_by_object[entry.id] = name
            self._account("taken", entry, name, name=name)
        elif values.get("deleted", "").strip().casefold() in {"true", "1", "yes"}:
            self._account("left out", entry, reason="it is marked as deleted", name=name)
        elif self._is_heading(values):
            self._headings[entry.id] = _fold_blanks(
                values.get("heading") or values.get("name") or values.get("text", "")
            )
            reason = (
                "a heading" if values.get("heading") else f"no requirement ({_fold_blanks(values.get('sort', ''))})"
            )
            self._account(
                "left out", entry, reason=reason, name=" ".join(filter(None, [name, self._headings[entry.id]]))
            )
        else:
            self._take_requirement(entry, meanings)
            derived_names = _DERIVED_ATTRIBUTES if type_name == REQUIREMENT_TYPE else frozenset()
            self._result.unread_attributes.update(set(meanings.unknown_names) - derived_names)

    @staticmethod
    def _is_heading(values: dict[str, str]) -> bool:
        if values.get("sort", "").strip().casefold() in HEADING_SORTS:
            return True
        return bool(values.get("heading")) and not values.get("text") and not values.get("name")

    def _take_requirement(self, entry: ReqifObject, meanings: ReadMeanings) -> None:
        values = meanings.values
        text, name = values.get("text", ""), _fold_blanks(values.get("name", ""))
        foreign_id, description = values.get("id", ""), values.get("description", "")
        if not (text or name or description):
            reason = "it has no text"
            self._account("not taken", entry, reason=reason, name=foreign_id)
            return
        if not foreign_id and not entry.id:
            self._account("not taken", entry, reason="it has no id", name=name)
            return
        prefix = values.get("prefix", "")
        shown_id = join_prefix(foreign_id, prefix) if foreign_id else ""
        made_id = self._known.find(entry.id, shown_id) or make_requirement_id(foreign_id, prefix, entry.id)
        if made_id in self._result.requirements:
            made_id = make_distinct_id(made_id, entry.id)
        if made_id in self._result.requirements:
            self._account("not taken", entry, reason=f"another object is `{made_id}` already", name=foreign_id)
            return
        body = _split_title(name, text or description, "" if not text else description)
        sort = values.get("sort", "")
        if "kind" not in values and sort.casefold() not in _PLAIN_SORTS:
            values["kind"] = sort
        body |= {key: word for key in ("kind", "priority") if (word := _make_word(_pick_first(meanings, key)))}
        body |= {"rationale": values["rationale"]} if values.get("rationale") else {}
        body |= {"source": _fold_blanks(values["source"])} if values.get("source") else {}
        tags = meanings.chosen.get("tags") or values.get("tags", "").split(",")
        if words := list(dict.fromkeys(word for tag in tags if (word := _make_word(tag)))):
            body["tags"] = words
        # An export of archgen's has archgen's identifiers, but for what came from another tool before.
        if self._document.source_tool != OWN_TOOL or entry.id != f"requirement-{made_id}":
            body["hints"] = make_identity_hints(entry.id, shown_id, made_id)
        self._result.requirements[made_id] = {
            key: value for key, value in body.items() if not (key == "title" and value == made_id)
        }
        self._id_by_object[entry.id] = made_id
        reasons = [f"`{shown_id}` is no id here"] if shown_id not in {"", made_id} else []
        reasons += _list_left_values(meanings)
        self._account("taken", entry, made_id, "; ".join(reasons), foreign_id)

    def _take_relations(self) -> None:
        for relation in self._document.relations:
            name = self._document.names.get(relation.type_id, "")
            source, target = self._id_by_object.get(relation.source), self._id_by_object.get(relation.target)
            verifier = self._verifier_by_object.get(relation.target)
            if source and verifier and name == USE_CASE_RELATION:
                _append_value(self._result.requirements[source], "use_cases", verifier)
            elif source and verifier and name == VERIFICATION_RELATION:
                _append_value(self._result.requirements[source], "verified_by", verifier)
            elif source and target and fold_attribute_name(name) in PART_RELATIONS and source != target:
                _append_value(self._result.requirements[source], "parent", target)
            else:
                self._result.unread_relations[name or "without a name"] += 1

    def _take_hierarchy(self) -> None:
        """Make each requirement a part of the nearest one above it; headings above become its source."""
        chains: list[tuple[str, str]] = []
        """For each entry the nearest requirement at or above it, and the headings above it."""
        for entry in self._document.entries:
            above, path = chains[entry.parent] if entry.parent >= 0 else ("", entry.specification)
            own_id = self._id_by_object.get(entry.object_id, "")
            heading = self._headings.get(entry.object_id, "")
            # A path as long as a deep tree would make the file grow with the square of it.
            next_path = f"{path}, {heading}" if heading and path and len(path) < _MAX_TITLE * 2 else path or heading
            chains.append((own_id or above, next_path))
            if own_id:
                self._place_requirement(own_id, above, path)

    def _place_requirement(self, own_id: str, above: str, path: str) -> None:
        body = self._result.requirements[own_id]
        if above and above != own_id:
            _append_value(body, "parent", above)
        if path and "source" not in body and self._document.source_tool != OWN_TOOL:
            body["source"] = _fold_blanks(path)


def _split_title(name: str, text: str, more: str) -> dict[str, Any]:
    """Return title and description of an object from its name and its texts."""
    if not name:
        # A title is plain text.
        first_line = _MARKS.sub("", _fold_blanks(text.partition("\n\n")[0]))
        if len(first_line) <= _MAX_TITLE and first_line == _fold_blanks(text):
            return {"title": first_line, **({"description": more} if more else {})}
        name = _SENTENCE_END.split(first_line, maxsplit=1)[0]
        name = name if len(name) <= _MAX_TITLE else f"{name[: _MAX_TITLE - 3].rstrip()}..."
    description = "\n\n".join(part for part in (text, more) if part and _fold_blanks(part) != name)
    return {"title": name, **({"description": description} if description else {})}


def _pick_first(meanings: ReadMeanings, key: str) -> str:
    """Return the value of an attribute that takes one word here: of an enumeration with several, the first."""
    return (meanings.chosen.get(key) or [meanings.values.get(key, "")])[0]


def _list_left_values(meanings: ReadMeanings) -> list[str]:
    """Say which values of enumerations are left out, since only one fits."""
    return [
        f"its {key} is `{_fold_blanks(words[0])}`, not also {', '.join(f'`{_fold_blanks(word)}`' for word in words[1:])}"
        for key in ("kind", "priority")
        if len(words := meanings.chosen.get(key, [])) > 1
    ]


def _append_value(body: dict[str, Any], key: str, value: str) -> None:
    # Keys keep their order, and a thousand relations of one object take no longer than of a thousand.
    body.setdefault(key, {})[value] = None


def _fold_blanks(text: str) -> str:
    return " ".join(text.split())


def _make_word(text: str) -> str:
    """Return a text as one word: `Must have` is `Must_have`."""
    return _WORD_SIGNS.sub("_", text.strip()).strip("_")[:64]


def cut_circles(parents: Mapping[str, dict[str, None]]) -> tuple[tuple[str, str], ...]:
    """Take out of the parents by id what closes a circle, and return it as (part, parent).

    Each requirement is walked once, so that the time is in proportion to the relations.
    """
    closing: list[tuple[str, str]] = []
    done: set[str] = set()
    for start in parents:
        if start not in done:
            closing += _walk_up(start, parents, done)
    for part, parent in closing:
        del parents[part][parent]
    return tuple(closing)


def _walk_up(start: str, parents: Mapping[str, dict[str, None]], done: set[str]) -> Iterator[tuple[str, str]]:
    """Yield the steps that lead from a requirement up to one on the way to it."""
    way = [(start, iter(parents[start]))]
    on_way = {start}
    while way:
        part, above = way[-1]
        parent = next(above, None)
        if parent is None:
            done.add(part)
            on_way.remove(part)
            way.pop()
        elif parent in on_way:
            yield part, parent
        elif parent not in done:
            on_way.add(parent)
            way.append((parent, iter(parents.get(parent, ()))))


_VALID = re.compile(r"[A-Za-z][A-Za-z0-9._-]*\Z")
_OTHER_SIGNS = re.compile(r"[^A-Za-z0-9._-]+")
_DIGEST_LENGTH = 8


def join_prefix(foreign_id: str, prefix: str) -> str:
    """Return the other tool's id as it shows it, on one line: its prefix, which may end in a blank, stands in front."""
    name, prefix = foreign_id.strip(), prefix.lstrip()
    return " ".join((name if name.startswith(prefix.rstrip()) else f"{prefix}{name}").split())


def make_requirement_id(foreign_id: str, prefix: str, identifier: str) -> str:
    """Return the id of an object: `SRS 12` is `SRS-12`, `Höhe 1` is `Hoehe-1`, a bare number 12 is `R-12`.

    `prefix` stands in front of it unless it does already; without a foreign id the object's own `identifier` is taken.
    """
    name = join_prefix(foreign_id.strip() or identifier, prefix)
    made_id = _OTHER_SIGNS.sub("-", spell_in_ascii(name)).strip("-._")
    if not made_id or (not name.isascii() and not re.search(r"[A-Za-z0-9]", made_id)):
        return f"R-{_digest(name)}"
    # YAML readers take `on`, `no` and the like for something else than text.
    if not made_id[0].isalpha() or needs_quotes(made_id):
        made_id = f"R-{made_id}"
    if len(made_id) > MAX_ID_LENGTH:
        made_id = f"{made_id[: MAX_ID_LENGTH - _DIGEST_LENGTH - 1].rstrip('-._')}-{_digest(name)}"
    return made_id


def make_distinct_id(wanted_id: str, identifier: str) -> str:
    """Return another id for an object whose id is taken: the same in each import."""
    return f"{wanted_id[: MAX_ID_LENGTH - _DIGEST_LENGTH - 1]}-{_digest(identifier)}"


def is_requirement_id(text: str) -> bool:
    """Whether a text is a valid id of a requirement."""
    return len(text) <= MAX_ID_LENGTH and _VALID.match(text) is not None


def _digest(text: str) -> str:
    return hashlib.sha256(text.encode("utf-8", "replace")).hexdigest()[:_DIGEST_LENGTH]
