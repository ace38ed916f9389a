"""A judge of AADL packages: their grammar as far as they use it, names that are used once, and names that lead somewhere."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass, field

from archgen.model.code_names import AADL_KEYWORDS

_TOKEN = re.compile(
    r'\s+|--[^\n]*\n|(?P<text>"[\x20\x21\x23-\x5b\x5d-\x7e]*")|(?P<word>[A-Za-z](?:_?[A-Za-z0-9])*)|(?P<number>\d+)'
    r"|(?P<sign>=>|->|::|\.\.|[:;,.(){}\[\]])"
)
_SECTIONS = ("prototypes", "features", "subcomponents", "connections", "flows", "properties")
_CATEGORIES = {"data", "process", "thread", "subprogram", "processor", "bus", "device", "system", "virtual"}


@dataclass
class Classifier:
    """A type or implementation: what it extends, and its sections as names with the tokens behind them."""

    name: str
    extends: str = ""
    sections: dict[str, list[tuple[str, list[str]]]] = field(default_factory=dict)


def split_tokens(text: str) -> list[str]:
    """Return the tokens of a file. Fail where something is none."""
    tokens, position = [], 0
    while position < len(text):
        match = _TOKEN.match(text, position)
        assert match, f"no word: {text[position : position + 60]!r}"
        if match.lastgroup:
            tokens.append(match[0])
        position = match.end()
    return tokens


def read_package(text: str) -> tuple[str, list[str], dict[str, Classifier]]:
    """Return the name of a package, what it uses, and its classifiers by their names in small letters."""
    tokens = split_tokens(text)
    assert tokens[0] == "package"
    name = tokens[1]
    assert tokens[2] == "public"
    assert tokens[-3:] == ["end", name, ";"]
    rest, uses = tokens[3:-3], []
    if rest[0] == "with":
        end = rest.index(";")
        uses, rest = [each for each in rest[1:end] if each != ","], rest[end + 1 :]
    classifiers: dict[str, Classifier] = {}
    while rest:
        length = _find_end(rest)
        classifier = _read_classifier(rest[:length])
        assert classifier.name.lower() not in classifiers, classifier.name
        classifiers[classifier.name.lower()] = classifier
        rest = rest[length:]
    assert classifiers, "a package is not empty"
    return name, uses, classifiers


def _find_end(tokens: list[str]) -> int:
    """Return where a classifier ends: behind `end NAME;`."""
    for index, word in enumerate(tokens):
        if word == "end" and tokens[index + 1] != "to" and tokens[index - 1] != "to":
            return tokens.index(";", index) + 1
    raise AssertionError(tokens[:5])


def _read_classifier(tokens: list[str]) -> Classifier:
    assert tokens[0] in _CATEGORIES, tokens[:4]
    index = 2 if tokens[0] == "virtual" else 1
    index += tokens[index] == "implementation"
    name, index = _read_name(tokens, index)
    end_name, _ = _read_name(tokens, len(tokens) - 1 - (3 if "." in name else 1))
    assert end_name == name
    classifier, body = Classifier(name), tokens[index : -3 - 2 * ("." in name)]
    if body[:1] == ["extends"]:
        classifier.extends, end = _read_name(body, 1)
        body = body[end:]
        if body[:1] == ["("]:
            body = body[body.index(")") + 1 :]
    for title, items in _split_sections(body):
        assert items, f"{name} has no {title}"
        classifier.sections[title] = items
    return classifier


def _read_name(tokens: list[str], index: int) -> tuple[str, int]:
    """Return a name of words joined by dots and colons, and where it ends."""
    end = index + 1
    while end < len(tokens) and tokens[end] in {".", "::"}:
        end += 2
    return "".join(tokens[index:end]), end


def _split_sections(tokens: list[str]) -> Iterator[tuple[str, list[tuple[str, list[str]]]]]:
    """Yield the sections of a classifier in their order, each with its items."""
    assert not tokens or tokens[0] in _SECTIONS, tokens[:5]
    title, item, depth = "", list[str](), 0
    items: list[tuple[str, list[str]]] = []
    for word in tokens:
        if not item and word in _SECTIONS and depth == 0:
            if title:
                assert _SECTIONS.index(title) < _SECTIONS.index(word)
                yield title, items
            title, items = word, []
            continue
        depth += (word in "({[") - (word in ")}]")
        if word == ";" and depth == 0:
            items.append((item[0], item))
            item = []
        else:
            item.append(word)
    assert not item, item
    if title:
        yield title, items


def judge_packages(files: dict[str, str]) -> dict[str, dict[str, Classifier]]:
    """Return the packages by name; fail where one is no AADL, or names something that is nowhere."""
    packages = {}
    units = {}
    for path, text in files.items():
        if "\nproperty set " in f"\n{text}":
            name = re.findall(r"^property set (\w+) is", text, re.MULTILINE)[0]
            assert f"end {name};" in text
            units[name.lower()] = set(re.findall(r"^  (\w+):", text, re.MULTILINE))
            continue
        name, uses, classifiers = read_package(text)
        assert path.endswith(f"/{name}.aadl")
        assert name.lower() not in packages
        packages[name.lower()] = classifiers
        units[name.lower()] = set()
        for unit in uses:
            assert f"{unit}::" in text, f"{name} does not use {unit}"
    for text in files.values():
        used = {match.lower() for match in re.findall(r"\b(\w+)::", re.sub(r'"[^"]*"|--[^\n]*', "", text))}
        for unit in used - {"base_types", "data_model"}:
            assert unit in units, unit
        own = re.findall(r"^(?:package|property set) (\w+)", text, re.MULTILINE)[0].lower()
        listed = re.search(r"^  with ([^;]*);", text, re.MULTILINE)
        known = {each.strip().lower() for each in listed[1].split(",")} if listed else set()
        assert used <= known | {own}, (own, used - known)
    for package, classifiers in packages.items():
        for classifier in classifiers.values():
            _judge_classifier(packages, units, package, classifier)
    return packages


def find_classifier(packages: dict[str, dict[str, Classifier]], package: str, name: str) -> tuple[str, Classifier]:
    """Return a classifier by its name from inside of a package, with the package that it stands in."""
    unit, _, own_name = name.rpartition("::")
    home = (unit or package).lower()
    return home, packages[home][own_name.lower()]


def _judge_classifier(
    packages: dict[str, dict[str, Classifier]], units: dict[str, set[str]], package: str, classifier: Classifier
) -> None:
    names: set[str] = set()
    for title in ("prototypes", "features", "subcomponents", "connections", "flows"):
        for name, tokens in classifier.sections.get(title, ()):
            assert name.lower() not in AADL_KEYWORDS, name
            if "refined" not in tokens:
                assert name.lower() not in names, f"{classifier.name} has two {name}"
            names.add(name.lower())
    for _, tokens in classifier.sections.get("connections", ()):
        for end in _list_ends(tokens):
            assert find_member(packages, package, classifier, end), (classifier.name, end)
    for items in classifier.sections.values():
        for _, tokens in items:
            _judge_names(packages, units, tokens)


def _judge_names(packages: dict[str, dict[str, Classifier]], units: dict[str, set[str]], tokens: list[str]) -> None:
    """Check that what is named of another package or property set is there."""
    for index, word in enumerate(tokens):
        if word == "::" and tokens[index - 1].lower() in units:
            unit, named = tokens[index - 1].lower(), tokens[index + 1]
            known = units[unit] or {each.name.partition(".")[0] for each in packages[unit].values()}
            assert named in known, f"{unit}::{named}"


def _list_ends(tokens: list[str]) -> list[str]:
    arrow = tokens.index("->")
    start = arrow - 1
    while tokens[start - 1] == ".":
        start -= 2
    _, end = _read_name(tokens, arrow + 1)
    return ["".join(tokens[start:arrow]), "".join(tokens[arrow + 1 : end])]


def find_member(
    packages: dict[str, dict[str, Classifier]], package: str, classifier: Classifier, path: str
) -> list[str] | None:
    """Return the tokens of what a path names from inside of a classifier: a feature, or that of a subcomponent."""
    first, _, rest = path.partition(".")
    found: tuple[str, list[str]] | None = None
    home: str | None = package
    seen = classifier
    own_type = seen.name.partition(".")[0].lower()
    candidates = [(package, packages[package][own_type]), (package, seen)]
    while candidates and found is None:
        home, seen = candidates.pop(0)
        for title in ("features", "subcomponents", "flows"):
            for name, tokens in seen.sections.get(title, ()):
                if name.lower() == first.lower():
                    found = (home, tokens)
        if seen.extends and not found:
            base_home, base = find_classifier(packages, home, seen.extends)
            candidates.append((base_home, base))
            candidates.append((base_home, packages[base_home][base.name.partition(".")[0].lower()]))
    if found is None or not rest:
        return found[1] if found else None
    home, tokens = found
    words = tokens[2:]
    while words[0] in _CATEGORIES | {"virtual"}:
        words = words[1:]
    name, _ = _read_name(words, 0)
    inner_home, inner = find_classifier(packages, home, name)
    return find_member(packages, inner_home, inner, rest)
