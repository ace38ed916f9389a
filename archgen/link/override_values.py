"""Read the values of overrides, and say what is wrong with them."""

from __future__ import annotations

_MAX_COUNT_DIGITS = 9


class OverrideError(ValueError):
    """A figure cannot be overridden; the message says why."""


def parse_count(text: str) -> int | None:
    """Return a whole number, None for any other text."""
    return int(text) if text.isascii() and text.isdigit() and len(text) <= _MAX_COUNT_DIGITS else None


def parse_counts(text: str) -> tuple[int, ...] | None:
    """Return a list of whole numbers in ascending order, each once; None for any other text."""
    numbers = [parse_count(word) for word in split_list(text)]
    return (
        tuple(sorted({number for number in numbers if number is not None})) if numbers and None not in numbers else None
    )


def split_list(text: str) -> list[str]:
    """Return the entries of a list as files have it; its brackets may be left out."""
    inner = text[1:-1] if text.startswith("[") and text.endswith("]") else text
    return [word.strip() for word in inner.split(",")] if inner.strip() else []


def require_value(key: str, text: str, parsed_value: object | None, expected: str) -> object:
    """Return a value that could be read. Raises `OverrideError` where it is None."""
    if parsed_value is not None:
        return parsed_value
    digits_hint = "; that has too many digits" if sum(map(str.isdigit, text)) > _MAX_COUNT_DIGITS else ""
    msg = f"`{key}` takes {expected}, not `{text}`{digits_hint}"
    raise OverrideError(msg)
