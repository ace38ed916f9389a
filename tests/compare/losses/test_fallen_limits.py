"""Promises and freshness that are kept no more: at which changes that is laid, and whom it breaks."""

from __future__ import annotations

import pytest

from archgen.compare import Comparison
from archgen.compare.asked_limits import describe_growth, describe_limit
from archgen.views.changes.breaking_verdict import write_missing_entries
from archgen.views.changes.figure_lines import write_limit_lines
from tests.compare.conftest import Compared, ComparedFolders

BASE = """\
project: {id: p, title: P}
partners: {a: A, b: B, c: C}
types: {Rows: std_msgs/msg/Int32}
review: {breaking: error}
hosts: {pc: {cores: 1, scheduling: fixed_priority}}
groups:
  sense:
    owner: a
    components:
      eye: {outputs: {rows: {type: Rows, promise: {max_gap: 130 ms}}}}
      other: Other
  act: {owner: b, components: {base: {inputs: {rows: eye.rows}}}}
  logging: {owner: c, components: {log: Log}}
nodes:
  eye: {implements: eye, host: pc, timing: {rate: 10 Hz, wcet: 5 ms}}
  other: {implements: other, host: pc, timing: {rate: 10 Hz, wcet: 5 ms}}
  base: {implements: base, host: pc, timing: {rate: 20 Hz, wcet: 5 ms}}
  log: {implements: log, host: pc, timing: {rate: 10 Hz, wcet: 5 ms}}
"""
PROMISE = "the promise of `sense.eye.rows` of gaps of at most 130 ms"
READ = "`act.base.rows` of B reads it"
WCET = "(worst case execution time)"
BOTH = f"`logging.log` {WCET} of C and `sense.other` {WCET} of A"


def load(other: str, log: str, project: str = BASE) -> str:
    """Return the project with other execution times of `other` and `log`."""
    for name, time in (("other", other), ("log", log)):
        lead = f"  {name}: {{implements: {name}, host: pc, timing: {{rate: 10 Hz"
        assert f"{lead}, wcet: 5 ms" in project
        project = project.replace(f"{lead}, wcet: 5 ms", f"{lead}, wcet: {time}" if time else lead)
    return project


def losses(comparison: Comparison) -> list[str]:
    """Return who is broken by which change, and why."""
    return [
        f"{change.element_id} {each.partner}: {each.reason}" for change in comparison.changes for each in change.breaks
    ]


def told(comparison: Comparison) -> list[str]:
    return [line.text for line in write_limit_lines(comparison)]


# Everything of the host: 20 ms beside the period of 100 ms; the gap is 120 ms.
CAUSES = {
    "one": (("60 ms", "5 ms"), [f"sense.other b: breaks {PROMISE} (120 ms → 180 ms); {READ}"]),
    "two, each of which is needed": (
        ("10 ms", "11 ms"),
        [
            f"{name} b: breaks {PROMISE} (120 ms → 131 ms); {BOTH} together: without either it holds; {READ}"
            for name in ("logging.log", "sense.other")
        ],
    ),
    "two, each of which is enough": (
        ("20 ms", "20 ms"),
        [
            f"{name} b: breaks {PROMISE} (120 ms → 150 ms); {BOTH}, each alone; {READ}"
            for name in ("logging.log", "sense.other")
        ],
    ),
    "one beside something better": (("60 ms", "4 ms"), [f"sense.other b: breaks {PROMISE} (120 ms → 179 ms); {READ}"]),
    "none, since something else makes up for it": (("16 ms", "0.1 ms"), []),
    "a figure that is taken away": (
        ("", "5 ms"),
        [
            f"sense.other b: leaves {PROMISE} no longer shown to be kept (120 ms → not known without figures of `other`); {READ}",
        ],
    ),
}


@pytest.mark.parametrize(("times", "said"), CAUSES.values(), ids=CAUSES)
def test_it_is_laid_at_what_it_would_not_be_without(
    compared: Compared, times: tuple[str, str], said: list[str]
) -> None:
    assert losses(compared(BASE, load(*times))) == said


def test_a_hair_over_the_limit_breaks(compared: Compared) -> None:
    before, after = load("15 ms", "5 ms"), load("15.01 ms", "5 ms")
    (line,) = losses(compared(before, after))
    assert line == f"sense.other b: breaks {PROMISE} (130 ms → ~131 ms); {READ}"


def test_what_was_broken_breaks_nobody_again(compared: Compared) -> None:
    comparison = compared(load("60 ms", "5 ms"), load("70 ms", "5 ms"))
    assert losses(comparison) == []
    assert told(comparison) == [f"{PROMISE} is broken by more than before (180 ms → 190 ms)"]
    assert told(compared(load("60 ms", "5 ms"), load("61 ms", "5 ms"))) == []  # less than the noise


STUB = ("  logging: {owner: c, components: {log: Log}}", "  logging: {owner: c, components: {log: Log, stub: Stub}}")
STUB_NODE = ("  log: {impl", "  stub: {implements: stub, host: pc, timing: {rate: 10 Hz}}\n  log: {impl")


def test_a_stub_without_figures_is_a_warning(compared: Compared) -> None:
    after = BASE.replace(*STUB).replace(*STUB_NODE)
    comparison = compared(BASE, after)
    assert losses(comparison) == []
    growth = "120 ms → not known without figures of `stub`"
    assert told(comparison) == [f"warning: {PROMISE} is no longer shown to be kept ({growth})"]
    # A figure that goes beside the stub is a break all the same: each alone is enough.
    assert [line.partition(":")[0] for line in losses(compared(BASE, load("", "5 ms", after)))] == [
        "logging.stub b",
        "sense.other b",
    ]


STATES = {
    "kept again": (load("60 ms", "5 ms"), BASE, [f"{PROMISE} is kept again (180 ms → 120 ms)"]),
    "shown to be kept": (
        load("", "5 ms"),
        BASE,
        [f"{PROMISE} is shown to be kept now (not known without figures of `other` → 120 ms)"],
    ),
    "not known any more": (
        load("120 ms", "5 ms"),
        load("", "5 ms"),
        [f"{PROMISE} was broken, and nobody knows it any more (no bound → not known without figures of `other`)"],
    ),
    "not known before": (load("", "5 ms"), load("60 ms", "5 ms"), []),
    "not asked before": (load("60 ms", "5 ms").replace("promise: {max_gap: 130 ms}", ""), load("60 ms", "5 ms"), []),
}


@pytest.mark.parametrize(("before", "after", "lines"), STATES.values(), ids=STATES)
def test_what_breaks_nobody_is_told(compared: Compared, before: str, after: str, lines: list[str]) -> None:
    comparison = compared(before, after)
    assert losses(comparison) == []
    assert told(comparison) == lines


@pytest.mark.parametrize(("name", "concerned"), [("not known before", {"a", "b"}), ("not asked before", {"a"})])
def test_what_is_broken_from_the_beginning_is_a_finding(compared: Compared, name: str, concerned: set[str]) -> None:
    before, after, _ = STATES[name]
    comparison = compared(before, after)
    assert [finding.rule for finding in comparison.new_findings] == ["broken-promise"]
    assert concerned <= set(comparison.concerned_owners)


def test_what_cannot_be_read_names_nobody(compared_folders: ComparedFolders) -> None:
    head, _, nodes = BASE.partition("nodes:")
    start = f"{head}sources: [nodes.yaml]\n"
    files = {"archgen.yaml": start, "nodes.yaml": f"nodes:{nodes}"}
    comparison = compared_folders(
        files, {**files, "nodes.yaml": f"nodes:{load('60 ms', '5 ms').partition('nodes:')[2]}x"}
    )
    assert (losses(comparison), comparison.limits, comparison.is_judged) == ([], (), False)


LIMITS = {
    "a stricter promise that is not kept": (
        [("130 ms", "110 ms")],
        [f"sense.eye.rows b: breaks {PROMISE.replace('130', '110')} (120 ms); {READ}"],
    ),
    "a looser promise does not help": (
        [("130 ms", "200 ms"), ("other, host: pc, timing: {rate: 10 Hz, wcet: 5", "other, host: pc, timing: {rate: 10 Hz, wcet: 60")],
        [
            f"sense.eye.rows b: promises for `sense.eye.rows` a largest gap of 200 ms instead of 130 ms; {READ}",
            f"sense.other b: breaks {PROMISE} (120 ms → 180 ms); {READ}",
        ],
    ),
    "a rate": (
        [("{rate: 10 Hz, wcet: 5 ms}}\n  other", "{rate: 9.5 Hz, wcet: 5 ms}}\n  other")],
        [f"sense.eye b: breaks the promise of `sense.eye.rows` of 10 Hz (10 Hz → 9.5 Hz); {READ}"],
    ),
    "a freshness": (
        [("timing: {rate: 20 Hz, wcet: 5 ms}", "timing: {rate: 20 Hz, wcet: 5 ms, priority: 1}"), ("log, host: pc, timing: {rate: 10 Hz, wcet: 5", "log, host: pc, timing: {rate: 10 Hz, wcet: 60")],
        [
            "logging.log b: breaks the freshness of 150 ms of what `act.base.rows` reads (135 ms → 180 ms); `act.base.rows` of B asks for it"
        ],
    ),
    "a freshness that the reader himself breaks": ([("rate: 20 Hz", "rate: 4 Hz")], []),
    "a freshness that is asked for newly": ([("freshness: 150 ms", "freshness: 100 ms")], []),
    "a deadline that is offered": (
        [("log, host: pc, timing: {rate: 10 Hz, wcet: 5", "log, host: pc, timing: {rate: 10 Hz, wcet: 60")],
        [
            f"logging.log b: breaks the deadline of 150 ms that is offered for `sense.eye.rows` (120 ms → 180 ms); {READ}"
        ],
    ),
    "a gap between what is sent now and then": (
        [("log, host: pc, timing: {rate: 10 Hz, wcet: 5", "log, host: pc, timing: {rate: 10 Hz, wcet: 60")],
        [f"logging.log b: breaks the largest gap of 130 ms of `sense.eye.rows` (130 ms → 180 ms); {READ}"],
    ),
}  # fmt: skip


@pytest.mark.parametrize(("edits", "said"), LIMITS.values(), ids=LIMITS)
def test_all_that_is_asked_is_judged(
    compared: Compared, edits: list[tuple[str, str]], said: list[str], request: pytest.FixtureRequest
) -> None:
    name = request.node.callspec.id
    base = BASE.replace("max_gap: 130 ms", "rate: 10 Hz") if name == "a rate" else BASE
    if "freshness" in name:
        base = BASE.replace("promise: {max_gap: 130 ms}", "").replace(
            "{rows: eye.rows}", "{rows: {from: eye.rows, freshness: 150 ms}}"
        )
    if name == "a deadline that is offered":
        base = BASE.replace("promise: {max_gap: 130 ms}", "").replace(
            "  eye: {implements: eye,", "  eye: {implements: eye, publishes: {rows: {qos: {deadline: 150 ms}}},"
        )
    if name == "a gap between what is sent now and then":
        base = BASE.replace("promise: {max_gap: 130 ms}", "").replace(
            "eye, host: pc, timing: {",
            "eye, host: pc, timing: {outputs: {rows: {conditional: true, max_gap: 130 ms}}, ",
        )
    after = base
    for old, new in edits:
        assert old in after
        after = after.replace(old, new)
    assert sorted(losses(compared(base, after))) == said


MORE = [f"more{number}" for number in range(9)]


def test_of_too_many_changes_all_are_named(compared: Compared) -> None:
    project = BASE.replace("{log: Log}", "{" + ", ".join(f"{name}: X" for name in ["log", *MORE]) + "}")
    project += "".join(
        f"  {name}: {{implements: {name}, host: pc, timing: {{rate: 10 Hz, wcet: 0.1 ms}}}}\n" for name in MORE
    )
    said = losses(compared(project, project.replace("wcet: 0.1 ms", "wcet: 3 ms")))
    assert [line.partition(" ")[0] for line in said] == [f"logging.{name}" for name in MORE]
    assert all("; causes not separated; " in line for line in said)


def test_an_entry_may_accept_what_is_not_kept(compared_folders: ComparedFolders) -> None:
    files = {"archgen.yaml": BASE}
    after = {"archgen.yaml": load("20 ms", "20 ms")}
    refused = compared_folders(files, after)
    (entries,) = write_missing_entries(refused)
    line = 'sense.eye.rows: {key: max_gap, was: "462c98", reason: THE REASON}'
    assert entries == f"# review/b.yaml\nreview:\n  accepted:\n    {line}"
    accepted = compared_folders(files, {**after, "review/b.yaml": entries})
    assert not accepted.is_refused
    assert all(each.agreement == "THE REASON" for change in accepted.changes for each in change.breaks)
    assert accepted.idle_acceptances == ()
    # Other causes are another loss.
    worse = compared_folders(files, {"archgen.yaml": load("20 ms", "30 ms"), "review/b.yaml": entries})
    assert worse.is_refused
    other = compared_folders(files, {**after, "review/b.yaml": entries.replace("max_gap", "max_age")})
    assert other.is_refused
    assert [entry.key for entry in other.idle_acceptances] == ["max_age"]
    # It is no other cause that was agreed on.
    assert compared_folders(files, {"archgen.yaml": load("21 ms", "20 ms"), "review/b.yaml": entries}).is_refused


def test_a_limit_is_told_by_its_figures(compared: Compared) -> None:
    (limit,) = compared(BASE, load("60 ms", "5 ms")).limits
    assert (limit.port, limit.key, limit.old_state, limit.new_state) == ("sense.eye.rows", "max_gap", "kept", "broken")
    assert (describe_limit(limit), describe_growth(limit)) == (PROMISE, "120 ms → 180 ms")
