"""What follows for requirements from their tree: rows, wholes, all above and below; circles and great depth."""

from __future__ import annotations

from archgen.model.requirement import (
    Requirement,
    add_above,
    add_below,
    add_wholes,
    index_parts,
    list_below,
    walk_tree,
)
from tests.quiet_seconds import measure_quiet_seconds


def tree(text: str) -> dict[str, Requirement]:
    """Return requirements from `part:parent,parent` words."""
    pairs = [word.partition(":") for word in text.split()]
    return {name: Requirement(name, name, parents=tuple(filter(None, p.split(",")))) for name, _, p in pairs}


def rows(text: str) -> list[str]:
    return [f"{'-' * row.depth}{row.id}{'*' * row.is_repeated}" for row in walk_tree(tree(text))]


def test_the_tree_is_walked_from_the_top_and_what_stands_twice_is_told_once() -> None:
    assert rows("a b:a c:b d:a e") == ["a", "-b", "--c", "-d", "e"]
    assert rows("a b c:a,b d:c") == ["a", "-c", "--d", "b", "-c*"]


def test_a_circle_and_what_hangs_on_it_comes_last() -> None:
    assert rows("a:b b:a c:a d") == ["d", "a", "-b", "--a*", "-c"]
    assert rows("a:a") == ["a", "-a*"]


def test_a_whole_has_what_all_of_its_parts_have() -> None:
    requirements = tree("a b:a c:a d:c e:c,a")
    assert add_wholes(requirements, ["b", "d", "e"]) == {"a", "b", "c", "d", "e"}
    assert add_wholes(requirements, ["b", "d"]) == {"b", "d"}
    assert add_wholes(requirements, ["a", "unknown"]) == {"a"}
    assert add_wholes(tree("a:b b:a"), []) == set()
    assert add_wholes(tree("a:b b:a"), ["a"]) == {"a", "b"}


def test_all_above_and_below() -> None:
    requirements = tree("a b:a c:b,x d:c")
    assert list(list_below(index_parts(requirements), "a")) == ["b", "c", "d"]
    assert add_above(requirements, ["c", "d"]) == {"a", "b", "c", "x"}
    assert add_above(tree("a:b b:a"), ["a"]) == {"a", "b"}
    assert add_below(requirements, ["c", "unknown"]) == {"c", "d", "unknown"}


def test_ten_thousand_levels_are_walked_in_time() -> None:
    names = [f"R-{number}" for number in range(10_000)]
    deep = {name: Requirement(name, name, parents=(f"R-{n - 1}",) if n else ()) for n, name in enumerate(names)}

    def walk_everywhere() -> None:
        assert [row.depth for row in walk_tree(deep)] == list(range(10_000))
        assert len(add_wholes(deep, [names[-1]])) == len(add_below(deep, [names[0]])) == 10_000
        assert len(add_above(deep, names)) == 9_999

    assert measure_quiet_seconds(walk_everywhere) < 2
