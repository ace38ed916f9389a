"""Whom a changed declaration breaks: the partner whose node sets the parameter."""

from __future__ import annotations

import pytest

from tests.compare.conftest import Compared, ComparedFolders

ROBOT = """\
project: {id: robot}
partners: {vega: Vega, kite: Kite}
groups:
  sense:
    owner: vega
    components:
      eye:
        title: Eye
        parameters:
          gain: {type: float, value: 0.5, unit: m, range: [0, 2], choices: [0.5, 1.5]}
          other: 1
nodes: {eye: {implements: eye, owner: kite, parameters: {gain: 1.5}}}
"""
PLACE = "the parameter `gain` of `sense.eye`"


@pytest.mark.parametrize(
    ("old", "new", "breaks"),
    [
        ("unit: m", "unit: mm", [f"meaning kite: gives {PLACE} in `mm` instead of `m`; Kite sets it"]),
        ("unit: m, ", "", [f"meaning kite: gives {PLACE} in none instead of `m`; Kite sets it"]),
        ("gain: {type", "gian: {type", [f"wire kite: takes away {PLACE}; Kite sets it"]),
        (
            "range: [0, 2]",
            "range: [0, 1]",
            [
                f"wire kite: no longer takes a value of {PLACE} (`1.5` is outside of its range, `0` to `1`); Kite sets it"
            ],
        ),
        (
            "type: float",
            "type: integer",
            [f"wire kite: no longer takes a value of {PLACE} (`1.5` is no `integer`); Kite sets it"],
        ),
        (
            "[0.5, 1.5]",
            "[0.5, 2]",
            [f"wire kite: no longer takes a value of {PLACE} (`1.5` is none of its choices: `0.5`, `2`); Kite sets it"],
        ),
        ("range: [0, 2]", "range: [0, 3]", []),
        ("value: 0.5", "value: 1.5", []),
        ("other: 1", "other: 2", []),
        ("          other: 1\n", "", []),
        ("unit: m, range", "unit: m, description: Words, range", []),
    ],
)
def test_who_sets_a_parameter_is_told(compared: Compared, old: str, new: str, breaks: list[str]) -> None:
    assert old in ROBOT
    changes = compared(ROBOT, ROBOT.replace(old, new)).changes
    assert [f"{b.category} {b.partner}: {b.reason}" for change in changes for b in change.breaks] == breaks


def test_the_owner_of_the_component_is_not_told(compared: Compared) -> None:
    own = ROBOT.replace("owner: kite, ", "")
    assert [b for change in compared(own, own.replace("unit: m", "unit: mm")).changes for b in change.breaks] == []


TYPED = """\
project: {id: robot}
partners: {vega: Vega, kite: Kite}
component_types:
  eye: {owner: vega, parameters: {gain: {value: 0.5, unit: m, range: [0, 2]}, other: 1}}
groups:
  sense: {owner: vega, components: {left: {is: eye, parameters: {other: 2}}}}
  mind: {owner: kite, components: {right: {is: eye, parameters: {gain: 1.5}}, plain: {is: eye}}}
"""
TYPE_PLACE = "the parameter `gain` of the type `eye`"


@pytest.mark.parametrize(
    ("old", "new", "breaks"),
    [
        ("unit: m, ", "unit: mm, ", [f"meaning kite: gives {TYPE_PLACE} in `mm` instead of `m`; Kite sets it"]),
        ("gain: {value", "gian: {value", [f"wire kite: takes away {TYPE_PLACE}; Kite sets it"]),
        (
            "[0, 2]",
            "[0, 1]",
            [
                f"wire kite: no longer takes a value of {TYPE_PLACE} (`1.5` is outside of its range, `0` to `1`); Kite sets it"
            ],
        ),
        ("[0, 2]", "[0, 1.7]", []),
        ("value: 0.5", "value: 0.6", []),
        ("other: 1", "another: 1", []),
    ],
)
def test_whose_instance_sets_a_parameter_of_a_type_is_told(
    compared: Compared, old: str, new: str, breaks: list[str]
) -> None:
    assert old in TYPED
    changes = compared(TYPED, TYPED.replace(old, new)).changes
    assert [f"{b.category} {b.partner}: {b.reason}" for change in changes for b in change.breaks] == breaks


TYPES = """\
component_types: {eye: {parameters: {p: {value: 2, type: int, unit: m}}, outputs: {x: T}}}
"""
OWN_EYES = "groups: {see: {owner: certh, components: {a: {is: eye, parameters: {p: 3}}, b: {is: eye}}}}\n"
OTHER_EYE = "groups: {act: {owner: sssa, components: {c: {is: eye, parameters: {p: 4}}}}}\n"


@pytest.mark.parametrize(
    ("files", "partners"),
    [
        ({"certh/see.yaml": OWN_EYES + TYPES}, []),
        ({"certh/see.yaml": OWN_EYES, "certh/types.yaml": TYPES}, []),
        ({"certh/see.yaml": OWN_EYES, "common/types.yaml": TYPES}, []),  # all of its instances are theirs
        ({"certh/see.yaml": OWN_EYES + TYPES, "act.yaml": OTHER_EYE}, ["sssa"]),
        ({"see.yaml": OWN_EYES, "act.yaml": OTHER_EYE, "types.yaml": TYPES}, ["certh", "sssa"]),
        (
            {
                "see.yaml": OWN_EYES,
                "act.yaml": OTHER_EYE,
                "types.yaml": TYPES.replace("{eye: {", "{eye: {owner: certh, "),
            },
            ["sssa"],
        ),
    ],
)
def test_nobody_is_broken_by_a_component_type_of_his_own(
    compared_folders: ComparedFolders, files: dict[str, str], partners: list[str]
) -> None:
    first = "archgen: 1\nsources: ['**/*.yaml']\npartners: {certh: CERTH, sssa: SSSA}\n"
    after = {name: text.replace("unit: m}", "unit: mm}") for name, text in files.items()}
    comparison = compared_folders({"archgen.yaml": first, **files}, {"archgen.yaml": first, **after})
    assert [each.partner for change in comparison.changes for each in change.breaks] == partners
