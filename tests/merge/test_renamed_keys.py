"""Renames in one file: what the other side changed follows, and two names of one element are a conflict."""

from __future__ import annotations

from collections.abc import Callable

import pytest

from archgen.merge.file_merge import merge_contents
from archgen.merge.tree_merge import MappingValue, find_renames

DVL = "{functionality: Measures speed., outputs: {velocity: {type: Speed, rate: 5 Hz}}}"
BASE = f"""\
groups:
  sense:
    components:
      imu: {{outputs: {{turn: Turn}}}}
      dvl: {DVL}
      sonar: {{outputs: {{rows: Rows}}}}
variants:
  deep: {{title: Deep water, changes: {{hosts: {{pc: {{cores: 2}}}}}}}}
"""


def merge(ours: str, theirs: str, base: str = BASE) -> tuple[str, str | None]:
    merged = merge_contents(base.encode(), ours.encode(), theirs.encode())
    return merged.content.decode(), merged.problem


@pytest.mark.parametrize(
    ("old", "ours", "theirs", "path"),
    [
        ("dvl:", "doppler:", "doppler_log:", "groups.sense.components.dvl"),
        ("deep:", "deep_water:", "below_50_m:", "variants.deep"),
        ("sonar:", "echo:", "profiler:", "groups.sense.components.sonar"),
        ("velocity:", "speed:", "motion:", "groups.sense.components.dvl.outputs.velocity"),
    ],
)
def test_two_names_of_one_element_are_a_conflict(old: str, ours: str, theirs: str, path: str) -> None:
    text, problem = merge(BASE.replace(old, ours), BASE.replace(old, theirs))
    assert problem == f"both sides renamed `{path}`: it is `{ours[:-1]}` and `{theirs[:-1]}` now"
    assert "<<<<<<<" in text


def test_so_they_are_where_lines_merge() -> None:
    line = f"      dvl: {DVL}\n"
    ours = BASE.replace(line, "").replace("    components:\n", f"    components:\n{line.replace('dvl', 'doppler')}")
    theirs = BASE.replace(line, "").replace("variants:", f"{line.replace('dvl', 'log')}variants:")
    text, problem = merge(ours, theirs)
    assert problem == (
        "both sides renamed `groups.sense.components.dvl`: it is `doppler` and `log` now, and git takes the lines of both"
    )
    assert "<<<<<<<" not in text


RENAME = ("dvl:", "doppler:")


def edit_rate(text: str) -> str:
    return text.replace("5 Hz", "10 Hz")


def add_key(text: str) -> str:
    return text.replace("speed., ", "speed., role: sensor, ")


def write_in_lines(text: str) -> str:
    return text.replace(
        f"dvl: {DVL}",
        "dvl:\n        functionality: Measures speed.\n        outputs: # all\n          velocity: {type: Speed, rate: 10 Hz}",
    )


@pytest.mark.parametrize("edit", [edit_rate, add_key, write_in_lines])
def test_a_change_inside_follows_the_new_name_on_either_side(edit: Callable[[str], str]) -> None:
    renamed, edited = BASE.replace(*RENAME), edit(BASE)
    expected = edited.replace(*RENAME)
    assert merge(renamed, edited) == (expected, None)
    assert merge(edited, renamed) == (expected, None)


def test_both_names_alike_are_merged_with_what_each_side_changed() -> None:
    ours, theirs = (edit(BASE).replace(*RENAME) for edit in (edit_rate, add_key))
    assert merge(ours, theirs) == (add_key(edit_rate(BASE)).replace(*RENAME), None)


def test_an_output_renamed_in_a_component_that_is_renamed_follows_too() -> None:
    ours = BASE.replace(*RENAME)
    theirs = BASE.replace("velocity:", "speed:").replace("imu", "gyro")
    assert merge(ours, theirs) == (theirs.replace(*RENAME), None)


def test_what_one_side_renamed_and_the_other_one_took_away_is_a_conflict() -> None:
    without = BASE.replace(f"      dvl: {DVL}\n", "")
    for versions in ((BASE.replace(*RENAME), without), (without, BASE.replace(*RENAME))):
        _, problem = merge(*versions)
        assert problem == ("one side renamed `groups.sense.components.dvl` to `doppler`, the other one took it away")


def test_what_is_not_surely_the_same_does_not_follow() -> None:
    # Renamed and changed at once; one value alone; two elements alike.
    assert merge(edit_rate(BASE).replace(*RENAME), add_key(BASE))[1] == (
        "both sides changed `groups.sense.components.dvl`"
    )
    assert merge(BASE.replace("sonar:", "echo:"), BASE.replace("rows: Rows", "rows: Lines"))[1] == (
        "both sides changed `groups.sense.components.sonar`"
    )
    twins = BASE.replace(f"      dvl: {DVL}\n", f"      dvl: {DVL}\n      other: {DVL}\n")
    ours = twins.replace("dvl:", "one:").replace("other:", "two:")
    assert merge(ours, edit_rate(twins), twins)[1] == "both sides changed `groups.sense.components.dvl`"


def test_a_key_that_is_no_id_is_no_name() -> None:
    base = "nodes:\n  n: {wcet: 5 ms, rate: 10 Hz}\n"
    _, problem = merge(base.replace("wcet", "bcet"), base.replace("5 ms", "6 ms"), base)
    assert problem == "both sides changed `nodes.n.wcet`"


def test_nothing_is_renamed_where_a_side_has_nothing() -> None:
    nothing = MappingValue(())
    assert list(find_renames(nothing, nothing, nothing)) == []
