"""A comparison narrowed to what touches some components and nodes, and to what breaks somebody."""

from __future__ import annotations

from dataclasses import replace
from types import SimpleNamespace
from typing import cast

import pytest

from archgen.compare import Change, Comparison
from archgen.compare.breaking_changes import find_idle_acceptances, keep_breaking_only
from archgen.compare.comparison import ChainChange
from archgen.compare.select_changes import select_changes
from archgen.diagnostics.diagnostic import Severity
from archgen.model.selector_evaluation import Selection
from archgen.timing.analysis import ChainResult
from tests.compare.conftest import Compared, ComparedFolders

ROBOT = """\
partners: {certh: CERTH, sssa: SSSA, tum: TUM}
requirements: {R: {title: R}}
groups:
  g:
    owner: certh
    components:
      a: {requirements: [R], outputs: {x: T, y: U}}
      b: {inputs: {x: a.x}}
  h: {owner: sssa, components: {c: {inputs: {y: a.y}}}}
types: {T: {size: 1 kB}, U: {size: 1 kB}}
hosts: {pc: {cores: 4}, arm: {cores: 2}}
containers: {box: {host: arm, threads: 2}}
nodes:
  na: {implements: a, host: pc, publishes: {x: {topic: /x}}}
  nb: {implements: b, container: box}
  nc: {implements: c, host: arm}
chains: {k: {through: [a.x, b], deadline: 1 s}, l: {through: [nc], deadline: 1 s}}
views: {v: {show: g}}
project: {id: robot, title: Robot}
"""


def selected(components: str = "", nodes: str = "") -> Selection:
    return Selection(frozenset(components.split()), frozenset(nodes.split()))


def keys(changes: tuple[Change, ...]) -> list[str]:
    return [f"{change.element_kind} {change.element_id} {change.key or change.kind}" for change in changes]


@pytest.mark.parametrize(
    ("old", "new", "touched"),
    [
        ("size: 1 kB}, U", "size: 2 kB}, U", "g.a"),
        ("U: {size: 1 kB}", "U: {size: 2 kB}", "g.a"),
        ("{title: R}", "{title: S}", "g.a"),
        ("pc: {cores: 4}", "pc: {cores: 3}", "g.a na"),
        ("arm: {cores: 2}", "arm: {cores: 1}", "g.b h.c nb nc"),
        ("threads: 2", "threads: 1", "g.b nb"),
        ("topic: /x", "topic: /y", "g.a na"),
        ("implements: b,", "implements: b, package: p,", "g.b nb"),
        ("deadline: 1 s}, l", "deadline: 2 s}, l", "g.a g.b"),
        ("[nc], deadline: 1 s", "[nc], deadline: 2 s", "nc"),
        ("show: g", "show: h", ""),
        ("title: Robot", "title: Car", ""),
        ("sssa: SSSA", "sssa: {title: SSSA, contact: a@b.eu}", "h.c nc"),
        ("tum: TUM", "tum: {title: TUM, contact: a@b.eu}", ""),
        ("inputs: {x: a.x}", "inputs: {x: {from: a.x, description: D}}", "g.b"),
        ("  h: {", "  h: {description: D, ", "h.c"),
        ("inputs: {y: a.y}", "inputs: {y: a.x}", "h.c"),
    ],
)
def test_what_touches_an_element(compared: Compared, old: str, new: str, touched: str) -> None:
    assert old in ROBOT
    found = compared(ROBOT, ROBOT.replace(old, new, 1))
    assert found.changes
    for name in ("g.a", "g.b", "h.c"):
        side = selected(components=name)
        assert bool(select_changes(found, side, side).changes) is (name in touched.split()), name
        assert bool(select_changes(found, side, selected()).changes) is (name in touched.split()), name
    for name in ("na", "nb", "nc"):
        side = selected(nodes=name)
        kept = keys(select_changes(found, side, side).changes)
        if name in touched.split():
            assert kept, name


def test_chains_owners_and_findings_are_narrowed_too(compared: Compared) -> None:
    timed = ROBOT.replace("implements: a,", "implements: a, timing: {rate: 10 Hz, wcet: 1 ms},")
    timed = timed.replace("implements: b,", "implements: b, timing: {behaviour: event, wcet: 1 ms},")
    changed = (
        timed.replace("10 Hz", "5 Hz").replace("x: T, y: U", "x: T, y: U, z: U").replace("threads: 2", "threads: 1")
    )
    found = compared(timed, changed)
    assert [chain.id for chain in found.chains] == ["k"]
    assert {finding.element for finding in found.new_findings} >= {"g.a"}
    for name, chains, findings, owners in (
        ("g.a", ["k"], True, ("certh", "sssa")),
        ("g.b", ["k"], False, ("certh",)),
        # It reads what comes half as often now.
        ("h.c", [], False, ("certh", "sssa")),
    ):
        # Chains lead through the nodes of components.
        side = selected(name, f"n{name[-1]}")
        narrowed = select_changes(found, side, side)
        assert [chain.id for chain in narrowed.chains] == chains, name
        # The rate of `a` is the cause: of what touches `b` alone there is none.
        causes = [cause.element_id for chain in narrowed.chains for cause in chain.causes]
        assert causes == (["g.a"] if name == "g.a" else []), name
        assert bool([each for each in narrowed.new_findings if each.element == "g.a"]) is findings, name
        assert narrowed.concerned_owners == owners, name
    back = compared(changed, timed)
    assert [each.element for each in select_changes(back, selected("g.a"), selected("g.a")).cured_findings] == ["g.a"]
    assert select_changes(back, selected("h.c"), selected("h.c")).cured_findings == ()
    quiet = compared(changed, changed + "rules: {unread-output: off}\n")
    assert [each.element for each in select_changes(quiet, selected("g.a"), selected()).silenced_findings] == ["g.a"]
    assert select_changes(quiet, selected("h.c"), selected("h.c")).silenced_findings == ()


@pytest.mark.parametrize(("components", "nodes"), [("g.a", ""), ("h.c", ""), ("", "publisher"), ("g.b", "")])
def test_a_frame_touches_who_writes_it_and_who_uses_it(compared: Compared, components: str, nodes: str) -> None:
    text = ROBOT.replace("inputs: {y: a.y}", "inputs: {y: {from: a.y, frame: base}}").replace(
        "nodes:",
        "frames: {world: , base: {parent: world, by: a, rate: 5 Hz}, tool: {parent: world, by: publisher, rate: 9 Hz}}\nnodes:\n  publisher: {package: p}",
    )
    found = compared(text, text.replace("5 Hz", "4 Hz").replace("9 Hz", "8 Hz"))
    touched = {"g.a": ["frame base rate"], "h.c": ["frame base rate"], "publisher": ["frame tool rate"]}
    narrowed = select_changes(found, *[selected(components, nodes)] * 2)
    assert keys(narrowed.changes) == touched.get(components or nodes, [])


def test_a_node_selects_the_chain_through_its_components(compared: Compared) -> None:
    text = ROBOT.replace(
        "implements: c, host: arm", "implements: [c, b], host: arm, timing: {c: {rate: 10 Hz, wcet: 1 ms}}"
    )
    found = compared(text, text.replace("wcet: 1 ms", "wcet: 2 ms"))
    narrowed = select_changes(found, selected(nodes="nc"), selected(nodes="nc"))
    assert narrowed.changes == found.changes
    # Where a node implements several components, chains lead through `node.component`.
    chain = ChainChange("k", None, cast("ChainResult", SimpleNamespace(through=("na", "nc.b"))))
    found = replace(found, chains=(chain,))
    assert select_changes(found, selected(nodes="nc"), selected()).chains == (chain,)
    assert select_changes(found, selected(nodes="na"), selected()).chains == (chain,)
    assert select_changes(found, selected(nodes="nb"), selected()).chains == ()


def test_removed_and_renamed_elements_are_selected_by_their_old_ids(compared: Compared) -> None:
    without = (
        ROBOT.replace("      b: {inputs: {x: a.x}}\n", "")
        .replace("  nb: {implements: b, container: box}\n", "")
        .replace("[a.x, b]", "[a.x]")
    )
    found = compared(ROBOT, without)
    assert "component g.b removed" in keys(select_changes(found, selected("g.b"), selected()).changes)
    assert "component g.b removed" not in keys(select_changes(found, selected("h.c"), selected()).changes)
    renamed = compared(ROBOT, ROBOT.replace("  h: {", "  hall: {"))
    assert keys(select_changes(renamed, selected("h.c"), selected()).changes) == ["group hall renamed"]


def test_a_connection_that_was_removed_is_selected_by_either_id_of_its_reader(compared: Compared) -> None:
    text = ROBOT.replace("c: {inputs: {y: a.y}}", "c: {functionality: Shows what is there, inputs: {y: a.y, x: a.x}}")
    found = compared(
        text,
        text.replace("h: {owner: sssa, components: {c: ", "h: {owner: sssa, components: {d: ")
        .replace("is there, inputs: {y: a.y", "is there, inputs: {y: ")
        .replace("implements: c", "implements: d"),
    )
    lost = "connection h.c.y removed"
    assert lost in keys(found.changes)
    assert lost in keys(select_changes(found, selected("h.c"), selected()).changes)
    assert lost in keys(select_changes(found, selected(), selected("h.d")).changes)
    assert lost not in keys(select_changes(found, selected("g.b"), selected("g.b")).changes)


@pytest.mark.parametrize(
    ("element", "side", "is_kept"),
    [
        ("g.a", selected("g.a"), True),
        ("g.a.x", selected("g.a"), True),
        ("na", selected(nodes="na"), True),
        ("na.publishes.x", selected(nodes="na"), True),
        ("g", selected("g.a"), False),
        ("g.ab", selected("g.a"), False),
        (None, selected("g.a"), False),
    ],
)
def test_findings_are_selected_by_the_element_that_they_are_about(
    compared: Compared,
    element: str | None,
    side: Selection,
    is_kept: bool,  # noqa: FBT001
) -> None:
    found = compared(ROBOT, ROBOT.replace("x: T, y: U", "x: T, y: U, z: U"))
    finding = replace(found.new_findings[0], element=element)
    narrowed = select_changes(replace(found, new_findings=(finding,)), side, side)
    assert narrowed.new_findings == ((finding,) if is_kept else ())


REVIEWED = ROBOT + "review: {breaking: error}\n"
GONE = REVIEWED.replace("x: T, y: U", "x: T").replace("y: a.y", "y: ")


AGREED = "{reason: Agreed, key: removed}"


@pytest.mark.parametrize(
    ("policy", "entries", "refused", "idle"),
    [
        ("error", "", True, []),
        ("error", f"g.a.y: {AGREED}", False, []),
        ("error", "g.a.y: {reason: Agreed, key: type}", True, ["g.a.y"]),
        ("error", f"g.a.x: {AGREED}", True, ["g.a.x"]),
        ("error", f"g.a.y: {AGREED}, h.c: {AGREED}", False, ["h.c"]),
        ("warning", "", True, []),  # the stricter policy of both counts
    ],
)
def test_what_the_project_refuses(
    compared_folders: ComparedFolders,
    policy: str,
    entries: str,
    refused: bool,  # noqa: FBT001
    idle: list[str],
) -> None:
    after = {
        "archgen.yaml": GONE.replace("breaking: error", f"breaking: {policy}"),
        "review/sssa.yaml": f"review: {{accepted: {{{entries}}}}}\n",
    }
    found = compared_folders({"archgen.yaml": REVIEWED}, after)
    assert found.is_refused is refused
    assert [entry.element for entry in find_idle_acceptances(found.changes, found.after.architecture.review)] == idle
    assert [entry.element for entry in found.idle_acceptances] == idle


def test_a_warning_refuses_nothing_and_off_is_not_even_looked_at(compared: Compared) -> None:
    warned = compared(REVIEWED.replace("error", "warning"), GONE.replace("error", "warning"))
    assert (warned.is_refused, warned.policy.gravest) == (False, Severity.WARNING)
    assert [change.broken_partners for change in warned.changes if change.breaks] == [("sssa",)]
    quiet = compared(REVIEWED.replace("error", "off"), GONE.replace("error", "off"))
    assert (quiet.is_refused, quiet.policy.gravest) == (False, Severity.OFF)
    assert [change for change in quiet.changes if change.breaks] == []
    assert compared(ROBOT, ROBOT).policy.gravest is Severity.WARNING


def test_only_what_breaks(compared: Compared) -> None:
    found = compared(REVIEWED, GONE.replace("title: Robot", "title: Car"))
    narrowed: Comparison = keep_breaking_only(found)
    assert keys(narrowed.changes) == ["output g.a.y removed"]
    assert narrowed.only_breaking
    assert not found.only_breaking
    assert (narrowed.chains, narrowed.new_findings, narrowed.cured_findings) == ((), (), ())
    assert narrowed.concerned_owners == ("certh", "sssa")


def test_breaking_changes_come_first_and_accepted_ones_after_the_rest_of_them(
    compared: Compared, compared_folders: ComparedFolders
) -> None:
    other = (
        GONE.replace("title: Robot", "title: Car")
        .replace("x: T}", "}")
        .replace("x: a.x", "x: ")
        .replace("[a.x, b]", "[b]")
    )
    other = other.replace("h: {owner: sssa", "h: {tags: [new], owner: sssa")
    base = REVIEWED.replace("b: {inputs: {x: a.x}}", "b: {owner: tum, inputs: {x: a.x}}")
    other = other.replace("b: {inputs: {x: }}", "b: {owner: tum, inputs: {x: }}")
    plain = compared(base, other)
    assert [change.element_id for change in plain.changes if change.breaks] == ["g.a.x", "g.a.y"]
    assert [bool(change.breaks) for change in plain.changes][:3] == [True, True, False]
    agreement = f"review: {{accepted: {{g.a.x: {AGREED}}}}}\n"
    agreed = compared_folders({"archgen.yaml": base}, {"archgen.yaml": other, "review/tum.yaml": agreement})
    assert [change.element_id for change in agreed.changes if change.breaks] == ["g.a.y", "g.a.x"]


def test_a_comparison_in_which_nothing_differs_is_empty(compared: Compared) -> None:
    assert compared(ROBOT, ROBOT).is_empty
    found = compared(ROBOT, ROBOT.replace("title: Robot", "title: Car"))
    assert not found.is_empty
    unread = compared(ROBOT, ROBOT.replace("x: T, y: U", "x: T, y: U, z: U"))
    (finding,) = (each for each in unread.new_findings if each.rule == "unread-output")
    same = replace(found, changes=())
    assert same.is_empty
    assert not replace(same, new_findings=(finding,)).is_empty
    assert not replace(same, cured_findings=(finding,)).is_empty
    assert not replace(same, silenced_findings=(finding,)).is_empty
    assert not replace(same, chains=(ChainChange("k", None, None),)).is_empty
