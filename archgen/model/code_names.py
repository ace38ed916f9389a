"""Names of elements as identifiers of programming languages. Two names may become one: see `name_clashes`."""

from __future__ import annotations

import hashlib
import re
from collections.abc import Mapping
from functools import lru_cache

from archgen.model.element_ids import spell_in_ascii
from archgen.model.language_keywords import CPP_KEYWORDS, JAVA_KEYWORDS, PYTHON_KEYWORDS, ROS_KEYWORDS

MAX_NAME_LENGTH = 100
_WORD = re.compile(r"[A-Z]+(?![a-z])[0-9]*|[A-Z]?[a-z0-9]+|[A-Z]|[0-9]+")
_KEYWORDS: Mapping[str, frozenset[str]] = {
    "python": PYTHON_KEYWORDS,
    "cpp": CPP_KEYWORDS,
    "java": JAVA_KEYWORDS,
}


def list_name_words(name: str) -> list[str]:
    """Return the words of a name in ASCII: `left_arm`, `LeftArm` and `Left arm` have the same two."""
    return _WORD.findall(spell_in_ascii(name))


@lru_cache(16_384)
def make_snake_name(name: str) -> str:
    """Return a name in small words: `left_arm`. It is never empty, begins with a letter, and has at most 100 characters."""
    return _finish_name("_".join(word.lower() for word in list_name_words(name)), name, "x")


@lru_cache(16_384)
def make_camel_name(name: str) -> str:
    """Return a name in words that begin with a capital: `LeftArm`. It is never empty, and begins with a letter."""
    return _finish_name("".join(word[0].upper() + word[1:].lower() for word in list_name_words(name)), name, "X")


@lru_cache(16_384)
def make_lower_camel_name(name: str) -> str:
    """Return a name in words of which all but the first begin with a capital: `leftArm`. It is as `make_camel_name` says."""
    camel_name = make_camel_name(name)
    return camel_name[0].lower() + camel_name[1:]


@lru_cache(16_384)
def make_identifier_in(language: str, name: str) -> str:
    """Return a name as an identifier of `python`, `cpp` or `java`, letters of either case; a keyword gets `_` behind it."""
    # Two underscores in a row, or one in front, are the compiler's and the library's own.
    identifier = _finish_name("_".join(re.findall(r"[A-Za-z0-9]+", spell_in_ascii(name))), name, "x")
    return f"{identifier}_" if identifier in _KEYWORDS[language] else identifier


@lru_cache(16_384)
def make_ros_name(name: str) -> str:
    """Return a name as packages, nodes, parameters and fields of ROS have it; a keyword gets `_x` behind it.

    No name of ROS 2 ends in an underscore, or has two in a row.
    """
    ros_name = make_snake_name(name)
    return f"{ros_name}_x" if ros_name in ROS_KEYWORDS else ros_name


def _finish_name(made_name: str, name: str, prefix: str) -> str:
    """Return what was made of a name with a letter in front and not too long; a name without any letter gets a digest."""
    if not made_name:
        return f"{prefix}_{_digest(name)}" if prefix == "x" else f"{prefix}{_digest(name)}"
    if made_name[0].isdigit():
        made_name = prefix + made_name
    if len(made_name) > MAX_NAME_LENGTH:
        made_name = f"{made_name[: MAX_NAME_LENGTH - 7].rstrip('_')}_{_digest(name)}"
    return made_name


def _digest(name: str) -> str:
    return hashlib.sha256(name.encode("utf-8", "replace")).hexdigest()[:6]
