"""Agreements: the parameters that one partner declares and the other sets, operations, and what became of them."""

from __future__ import annotations

from pathlib import Path

from archgen.views.agreement.partner_agreement import PartnerAgreement, make_agreement
from tests.agreeing import checked, lines, section, view

ROBOT = """\
archgen: 1
partners: {acme: Acme, lab: Lab}
component_types:
  driver:
    owner: acme
    outputs: {scan: Scan}
    parameters: {rate: {value: 10, unit: Hz, range: [1, 50]}, gain: 1.0}
    operations: {reset: {response: Ok}, hide: {visibility: private}}
types: {Scan: sensor_msgs/msg/LaserScan}
groups:
  sensing:
    owner: acme
    components:
      front: {is: driver}
      plain: {outputs: {scan: Scan}, parameters: {level: {value: 3, range: [1, 5]}, own: 1}, operations: {stop: {request: {hard: bool}, call: synchronous}}}
  mind:
    owner: lab
    components:
      back: {is: driver, parameters: {rate: 40}}
      user: {inputs: {a: front.scan, b: back.scan, c: plain.scan}, operations: {ask: {response: Answer}}}
nodes:
  plain: {implements: plain, owner: lab, parameters: {level: 4}}
  front: {implements: front, parameters: {gain: 3.0}}
"""


def agree(folder: Path, after: str = ROBOT, before: str = "") -> PartnerAgreement:
    earlier = ("v1", view(checked(folder / "before", before))) if before else None
    return make_agreement(view(checked(folder / "after", after)), "acme", "lab", earlier_revision=earlier)


def list_settings(agreement: PartnerAgreement) -> list[str]:
    return lines(section(agreement.outline, "Parameters and operations").blocks)[1:]


def test_what_one_declares_and_the_other_sets_or_may_call(tmp_path: Path) -> None:
    """What a partner sets at its own component is its own business, and so is a private operation.

    Nobody calls `ask`: Acme takes nothing from it.
    """
    assert list_settings(agree(tmp_path)) == [
        "level | Plain | Acme |  | 1 to 5 | plain: 4",
        "rate | Back | Acme | Hz | 1 to 50 | Back: 40",
        "reset | Front | Acme |  | Ok | ",
        "stop | Plain | Acme | hard: bool |  | synchronous",
    ]


def test_without_any_there_is_no_section(tmp_path: Path) -> None:
    plain = ROBOT.replace("{level: 4}", "{}").replace("{rate: 40}", "{}").replace("operations: {", "hints: {")
    assert "Parameters and operations" not in {each.title for each in agree(tmp_path, plain).outline.sections}


def test_what_became_of_them_is_told_beside_the_interfaces(tmp_path: Path) -> None:
    changed = (
        ROBOT.replace("range: [1, 50]", "range: [1, 45]")
        .replace("hard: bool", "hard: int8")
        .replace("level: 4", "level: 5")
        .replace("ask: {response: Answer}", "")
    )
    agreement = agree(tmp_path, changed, ROBOT)
    assert lines(agreement.outline.notices) == [
        ("Parameters and operations that are not what they were at v1: mind.back: rate, sensing.plain: stop().")
    ]
    assert [row.rpartition(" | ")[2] for row in list_settings(agreement)] == ["", "~ changed", "", "~ changed"]
    assert lines(agree(tmp_path, ROBOT, ROBOT).outline.notices) == ["Nothing between the two has changed since v1."]
