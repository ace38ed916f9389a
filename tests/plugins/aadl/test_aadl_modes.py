"""archgen has no modes: what counts in some of them alone is taken as it is in the initial one, and told at its place."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.plugins.aadl.aadl_texts import import_package, merge_slices, tell_notes

NO_MODES = "3:1 modes: archgen has no modes: what changes when one follows another is not taken"


@pytest.mark.parametrize(
    ("properties", "period", "notes"),
    [
        (
            "Period => 10 ms in modes (slow), 2 ms in modes (fast);",
            "2 ms",
            [
                "Period has 2 values, each for other modes; the one of the initial mode counts, else that of no mode, else the first"
            ],
        ),
        (
            "Period => 10 ms in modes (slow), 5 ms in modes (still);",
            "10 ms",
            [
                "Period has 2 values, each for other modes; the one of the initial mode counts, else that of no mode, else the first"
            ],
        ),
        (
            "Period => 10 ms in modes (slow), 2 ms;",
            "2 ms",
            [
                "Period has 2 values, each for other modes; the one of the initial mode counts, else that of no mode, else the first"
            ],
        ),
        (
            "Period => 2 ms in modes (fast); Period => 10 ms in modes (slow);",
            "2 ms",
            ["Period has this value in mode fast alone; here it counts always"],
        ),
        (
            "Period => 10 ms in modes (slow, still); Period => 2 ms in modes (FAST);",
            "2 ms",
            ["Period has this value in mode FAST alone; here it counts always"],
        ),
        ("Period => 7 ms; Period => 10 ms in modes (slow);", "7 ms", []),
    ],
)
def test_of_the_values_of_a_property_the_one_of_the_initial_mode_counts(
    tmp_path: Path, properties: str, period: str, notes: list[str]
) -> None:
    imported = import_package(
        tmp_path,
        "process p features x: out data port; modes slow: mode; fast: initial mode; still: mode;"
        f" properties Dispatch_Protocol => Periodic; {properties} end p;",
    )
    assert merge_slices(imported)["component_types"]["p"]["timing"]["period"] == period
    told = [f"in modes: {note}" for note in notes]
    assert [note.partition(" ")[2] for note in tell_notes(imported)] == [*told, NO_MODES.partition(" ")[2]]


def test_what_stands_in_some_modes_alone_is_told_at_its_place(tmp_path: Path) -> None:
    imported = import_package(
        tmp_path,
        """\
system s end s;
process p features x: out data port; y: in data port; flows f: flow path y -> x; end p;
system implementation s.i
  subcomponents
    a: process p in modes (one);
    b: process p;
  connections
    c: port a.x -> b.y in modes (one, two);
  flows
    e: end to end flow a.f -> c -> b.f in modes (one, two, three, four, five);
  modes
    one: initial mode; two: mode;
    change: one -[a.x]-> two;
end s.i;
""",
    )
    assert sorted(tell_notes(imported)) == [
        "10:5 in modes: connection c is there in modes one and two alone; here it counts always",
        "12:5 in modes: flow e is there in modes one, two, three and 2 others alone; here it counts always",
        "5:1 modes: archgen has no modes: what changes when one follows another is not taken",
        "7:5 in modes: process a is there in mode one alone; here it counts always",
    ]
    assert set(merge_slices(imported)["nodes"]) == {"a", "b"}
    assert merge_slices(imported)["chains"] == {"e": {"through": ["s.a", "s.b"]}}
