"""Files that the second version has and does not read: what is gone because of it."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import pytest

from archgen.compare.comparison import Change
from archgen.compare.edits import find_affected_names, find_left_out
from tests.compare.elements import by_key, element, pair


def read_comparison(files: str, held: str) -> Any:  # noqa: ANN401
    """Return a comparison: the files that are left out, and what they held: `node n a.yaml, node m b.yaml g.c`."""
    elements = []
    for entry in held.split(", "):
        kind, name, file, *refs = entry.split(" ")
        one = element(f"{kind} {name}", refs=" ".join(refs))
        elements.append(SimpleNamespace(kind=kind, own_id=name, id=name, file=file, component_refs=one.component_refs))
    versions = SimpleNamespace(elements_before={(each.kind, each.id): each for each in elements})
    return SimpleNamespace(versions=versions, left_out_files=tuple(files.split()))


def read_changes(text: str) -> list[Change]:
    """Read `removed node n, added node m`."""
    words = [entry.split(" ") for entry in text.split(", ")]
    return [Change(kind, element_kind, name) for kind, element_kind, name in words]  # type: ignore[arg-type]


@pytest.mark.parametrize(
    ("files", "held", "changes", "expected"),
    [
        ("n.yaml", "node n n.yaml, node m m.yaml", "removed node n, removed node m", ["`sources` no longer names `n.yaml`: 1 node is not read any more [n]"]),
        ("n.yaml", "node n n.yaml, node m n.yaml", "removed node n, removed node m", ["`sources` no longer names `n.yaml`: 2 nodes are not read any more [n m]"]),
        ("n.yaml", "node n n.yaml, chain c n.yaml", "removed node n, removed chain c", ["`sources` no longer names `n.yaml`: 1 node and 1 chain are not read any more [n c]"]),
        # What only changed, and what came, is read.
        ("n.yaml", "node n n.yaml", "changed node n", []),
        ("n.yaml", "node n n.yaml", "added node n", []),
        ("n.yaml", "node n o.yaml", "removed node n", []),
        # A file of a message is another setting, and names what it defines.
        ("p/msg/Go.msg", "message p/msg/Go o.yaml", "removed message p/msg/Go", ["`ros.interfaces` no longer names `p/msg/Go.msg`: 1 message definition is not read any more [p/msg/Go]"]),
        ("x/Go.msg", "message p/msg/Go o.yaml", "removed message p/msg/Go", ["`ros.interfaces` no longer names `x/Go.msg`: 1 message definition is not read any more [p/msg/Go]"]),
        ("x/Go.srv", "message p/msg/Go o.yaml", "removed message p/msg/Go", []),
        ("x/No.msg", "message p/msg/Go o.yaml", "removed message p/msg/Go", []),
        ("x/Go.msg", "node p/msg/Go o.yaml", "removed node p/msg/Go", []),
        ("n.yaml p/srv/S.srv", "node n n.yaml", "removed node n, removed message p/srv/S", ["`sources` no longer names `n.yaml`: 1 node is not read any more [n]", "`ros.interfaces` no longer names `p/srv/S.srv`: 1 message definition is not read any more [p/srv/S]"]),
        # Four files are named.
        ("a.y b.y c.y d.y", "node n d.y", "removed node n", ["`sources` no longer names `a.y`, `b.y`, `c.y` and `d.y`: 1 node is not read any more [n]"]),
        ("a.y b.y c.y d.y e.y", "node n e.y", "removed node n", ["`sources` no longer names `a.y`, `b.y`, `c.y` and 2 more: 1 node is not read any more [n]"]),
    ],
)  # fmt: skip
def test_what_a_setting_no_longer_names(files: str, held: str, changes: str, expected: list[str]) -> None:
    left_out = find_left_out(read_comparison(files, held), read_changes(changes))
    assert [f"{each.text} [{' '.join(change.element_id for change in each.removals)}]" for each in left_out] == expected


def test_findings_about_it_and_about_its_components_follow_from_it() -> None:
    comparison = read_comparison("n.yaml", "node n n.yaml g.a g.b, node m m.yaml g.c")
    assert find_affected_names(comparison, read_changes("removed node n")) == {"n", "g.a", "g.b"}
    by_name = SimpleNamespace(versions=pair(by_key(element("node n", own_id="old", refs="g.a")), {}))
    assert find_affected_names(by_name, read_changes("removed node n")) == {"n"}  # type: ignore[arg-type]
