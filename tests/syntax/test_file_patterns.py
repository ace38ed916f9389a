"""File patterns: what they match, and that no pattern takes long."""

from __future__ import annotations

import pytest

from archgen.syntax.file_patterns import matches_pattern


@pytest.mark.parametrize(
    ("pattern", "file"),
    [
        ("*.yaml", "a.yaml"),
        ("groups/*.yaml", "groups/.yaml"),
        ("**/*.yaml", "a.yaml"),
        ("**/*.yaml", "a/b/c.yaml"),
        ("a/**", "a/b"),
        ("a/**", "a/b/c"),
        ("a/**/b/**/c", "a/x/b/y/b/c"),
        ("**/**/x", "x"),
        ("*a*b", "xxaxbab"),
        ("**a", "ba"),
        ("[ab]?.yaml", "bz.yaml"),
        ("[!a].yaml", "b.yaml"),
        ("[!b-a].yaml", "b.yaml"),
        ("[--0].yaml", "0.yaml"),
        ("[+--].yaml", "-.yaml"),
    ],
)
def test_a_pattern_matches(pattern: str, file: str) -> None:
    assert matches_pattern(pattern, file)


@pytest.mark.parametrize(
    ("pattern", "file"),
    [
        ("*.yaml", "a/b.yaml"),
        ("a/**", "a"),
        ("a/**", "b/a/c"),
        ("a/**/c", "a/b"),
        ("**/b/c", "a/b/c/d"),
        ("*a*b", "xxbxa"),
        ("?", ""),
        ("[!a].yaml", "a.yaml"),
        ("[ab]*", "ca"),
        ("[b-a].yaml", "b.yaml"),
        ("[a--b].yaml", "c.yaml"),
        ("../*", "../a"),
        ("/*", "/a"),
    ],
)
def test_a_pattern_does_not_match(pattern: str, file: str) -> None:
    assert not matches_pattern(pattern, file)


@pytest.mark.parametrize(
    ("pattern", "file"),
    [
        ("*a" * 14 + "b.yaml", "a" * 200 + ".yaml"),
        ("**/" * 30 + "x.yaml", "d/" * 40 + "y.yaml"),
        ("**/a/" * 20 + "x.yaml", "a/" * 200 + "y.yaml"),
        ("*" * 5000 + "x", "a" * 250),
    ],
)
def test_no_pattern_takes_exponential_time(pattern: str, file: str) -> None:
    """The expressions before this test took more than a minute for each of these; here a hang is the failure."""
    assert not matches_pattern(pattern, file)


def test_no_name_is_longer_than_file_systems_take() -> None:
    assert matches_pattern("*" + "a" * 255, "a" * 255)
    assert not matches_pattern("*" + "a" * 256, "a" * 256)
    assert matches_pattern("[a]" * 255, "a" * 255)
