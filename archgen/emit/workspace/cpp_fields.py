"""Where C++ takes a field of what it holds: read by its words, as far as they say what class that is."""

from __future__ import annotations

import re
from collections.abc import Iterable


def find_field(code: str, field_name: str, class_name: str, calls: Iterable[str]) -> re.Match[str] | None:
    """Find where a field of a class is taken: `message->speed`. The node's `calls` answer with the class."""
    name = re.escape(class_name)
    declared = re.compile(rf"\b{name}(?:::\w++)?\s*+[&*]*+\s*+(\w+)|\b(\w++)\s*+=\s*+std::make_\w++<{name}>")
    names = {each[1] or each[2] for each in declared.finditer(code)}
    holders = "|".join(sorted(names.union(*(_find_answers(code, call) for call in calls))))
    taken = rf"\b(?:{holders})\s*(?:\.\s*get\s*\(\s*\)\s*)?(?:\.|->)\s*(?={field_name}\b)"
    return re.search(taken, code) if holders else None


def _find_answers(code: str, call: str) -> set[str]:
    """Return what code calls the answer of a service, or its future, with `auto`: its own, or what a function of no name is given."""
    called = rf"\b{call}\s*\("
    own = rf"\bauto\b[\s&*]*(\w+)\s*=[^;{{}}]{{0,300}}?{called}"
    given = rf"{called}[^;{{}}]{{0,300}}?\]\s*\((?:\s*const\b)?\s*auto\b[\s&*]*(\w+)"
    names = {each[1] or each[2] for each in re.finditer(f"{own}|{given}", code)}
    taken = rf"\bauto\b[\s&*]*(\w+)\s*=[\s*]*(?:{'|'.join(sorted(names))})\s*\.\s*get\s*\("
    return names | ({each[1] for each in re.finditer(taken, code)} if names else set())
