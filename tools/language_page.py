"""Write what docs/language.md says of kinds and keys from the description: the table of keys, and which declare nothing."""

from __future__ import annotations

import re
from collections.abc import Iterator

from language_description import SLICE, Description, list_accepted

_ANNOTATIONS = frozenset({"properties", "hints"})
"""Keys of every element: the page says so once."""
_APART = frozenset({SLICE, "variant_changes", "rules", "layout", "site", "accepted", "accepted_key", "parameter"})
"""Kinds that the page shows as a whole file, or in sections of their own."""


def renew_page(page: str, description: Description) -> str:
    """Return the page with what stands between its marks as the description has it."""
    page = _replace_part(page, "keys", "\n".join(["", *_list_rows(description), ""]))
    return _replace_part(page, "supporting keys", _list_supporting_keys(description))


def _replace_part(page: str, name: str, text: str) -> str:
    pattern = re.compile(rf"(<!-- {name} -->).*?(<!-- end of {name} -->)", re.DOTALL)
    if not pattern.search(page):
        message = f"docs/language.md: the marks `<!-- {name} -->` and `<!-- end of {name} -->` are missing"
        raise ValueError(message)
    return pattern.sub(lambda match: f"{match[1]}{text}{match[2]}", page)


def _list_rows(description: Description) -> Iterator[str]:
    yield "| element | a scalar stands for | keys |"
    yield "|---|---|---|"
    for kind, part in description.kinds.items():
        if kind in _APART:
            continue
        short = part.get("short", [])
        short_keys = [short] if isinstance(short, str) else short
        stands_for = " and ".join(f"`{key}`" for key in short_keys)
        if stands_for and "array" in list_accepted(part):
            stands_for += " (a list too)"
        keys = " ".join(key for key in description.keys_of(kind) if key not in _ANNOTATIONS)
        note = f"; {part['see']}" if "see" in part else ""
        yield f"| {kind.replace('_', ' ')} | {stands_for} | {keys}{note} |"


def _list_supporting_keys(description: Description) -> str:
    keys = [key for key, said in description.keys_of("component").items() if said.get("declares") is False]
    return f"{', '.join(keys[:-1])} or {keys[-1]}"
