"""What agreements say in words: what partners wrote, what the model knows, and what nobody said."""

from __future__ import annotations

from pathlib import Path

import pytest

from archgen.pipeline import CheckedProject
from archgen.views.agreement.general_sections import describe_standing, list_start_steps, list_variant_differences
from archgen.views.agreement.interface_sections import list_word_rows
from archgen.views.agreement.partner_agreement import make_agreement, record_interfaces
from archgen.views.agreement.term_changes import AgreementChanges
from tests.agreeing import checked, lines, section, text, view

ROBOT = """\
archgen: 1
ros:
  distro: jazzy
  definitions: {m_msgs/msg/Stop: "uint8 what\\n", m_msgs/msg/Scan: "# All of it.\\nstd_msgs/Header header # when\\nfloat32 x # m\\n"}
partners: {a: A, b: B}
groups:
  sense: {owner: a, components: {eye: {outputs: {scan: {type: Scan, promise: {max_gap: 1 s, max_age: 2 s}}, stop: Stop}}}}
  drive: {owner: b, components: {base: {inputs: {scan: {from: eye.scan, freshness: 3 s}, stop: eye.stop}}}}
types: {Stop: m_msgs/msg/Stop, Scan: m_msgs/msg/Scan}
nodes:
  eye_node: {implements: eye, host: pc, timing: {rate: 10 Hz, outputs: {scan: {conditional: true}}}}
  base_node: {implements: base, host: pc}
hosts: {pc: {title: PC}, other: {title: Other PC}}
"""


def say(folder: Path, *edits: tuple[str, str]) -> dict[str, str]:
    """Give the terms in words of what reads `scan`, by their titles."""
    source = ROBOT
    for old, new in edits:
        assert old in source
        source = source.replace(old, new, 1)
    lookup = view(checked(folder, source))
    (record, _) = record_interfaces(lookup, ("a", "b"))
    steps = list_start_steps(lookup.architecture)
    return {row.title: text(row.inlines) for row in list_word_rows(lookup, record.terms, steps)}


def test_what_is_known_and_what_nobody_said(tmp_path: Path) -> None:
    assert say(tmp_path) == {
        "When late or missing": (
            "It is sent only when there is something to send, but A lets no more than 1 s pass between two messages.\n"
            "A promises that what is read is no older than 2 s."
        ),
        "Time stamps": "nothing is said of whether header.stamp is of measuring or of sending",
        "Clock": "The clock of PC, on which both sides run.",
        "After power-up": "nothing is said of it",
        "Duties of readers": "Base uses nothing older than 3 s as scan.",
    }


@pytest.mark.parametrize(
    ("edit", "title", "told"),
    [
        (
            ("scan: {conditional: true}", "x: {}"),
            "When late or missing",
            "A lets no more than 1 s pass between two messages.",
        ),
        (
            ("base, host: pc", "base, host: other"),
            "Clock",
            "The clocks of PC and Other PC.\nnothing is said of how far they may differ",
        ),
        (
            ("base, host: pc", "base"),
            "Clock",
            "which computers the ends run on is not decided, and nothing is said of their clocks",
        ),
        (
            ("header # when", "other # when"),
            "Time stamps",
            "nothing is said of whether other.stamp is of measuring or of sending",
        ),
        (("std_msgs/Header header # when\\n", ""), "Time stamps", "The message holds no time stamp."),
        (
            ("eye, host", "eye, start: {ready: {wait: 2 s}}, host"),
            "After power-up",
            "eye_node is up when 2 s have passed.",
        ),
        (("hosts:", "agreements: {a-b: {terms: {stamps: of measuring}}}\nhosts:"), "Time stamps", "of measuring"),
        (
            ("hosts:", "agreements: {b-a: {interfaces: {sense.eye.scan: {duties: Be quick.}}}}\nhosts:"),
            "Duties of readers",
            "Be quick.\nBase uses nothing older than 3 s as scan.",
        ),
    ],
)
def test_each_term(tmp_path: Path, edit: tuple[str, str], title: str, told: str) -> None:
    assert say(tmp_path, edit)[title].startswith(told)


def test_what_stands_on_top_of_a_message_is_no_meaning_of_its_header(tmp_path: Path) -> None:
    said = lines(section(make_agreement(view(checked(tmp_path, ROBOT)), "a", "b").outline, "Eye · scan").blocks)
    assert "About the message: All of it." in said
    assert "header | std_msgs/msg/Header | when" in said
    spoken = ROBOT.replace("# All of it.", "# Stamped when measured.")
    said = lines(section(make_agreement(view(checked(tmp_path, spoken)), "a", "b").outline, "Eye · scan").blocks)
    assert "header | std_msgs/msg/Header | Stamped when measured. when" in said


def terms_of(project: CheckedProject) -> list[str]:
    variants = {name: view(variant) for name, variant in project.variants.items()}
    agreement = make_agreement(view(project), "a", "b", standing=project.steps, variants=variants)
    return lines(section(agreement.outline, "Terms").blocks)[1:]


def test_what_holds_for_all(tmp_path: Path) -> None:
    words = "agreements: {a-b: {terms: {notice: 30 days, other: Peace.}}}\n"
    assert terms_of(checked(tmp_path, ROBOT + words)) == [
        "Notice of changes: 30 days",
        "Validity: nothing is said of it",
        "Other terms: Peace.",
        "Variants: The project has no variants: what stands here holds always.",
    ]


def test_what_differs_in_variants(tmp_path: Path) -> None:
    variants = """\
variants:
  slow: {title: Slow, changes: {nodes: {eye_node: {timing: {rate: 5 Hz}}}}}
  blind: {title: Blind, without: base}
  same: {changes: {nodes: {eye_node: {timing: {wcet: 1 ms}}}}}
"""
    project = checked(tmp_path, ROBOT + variants)
    assert terms_of(project)[3:] == [
        "Variants: This document holds for the project without its variants.",
        (
            "Slow | sense.eye.scan: Rate (promised): at most 5 Hz; here: at most 10 Hz.\n"
            "sense.eye.stop: Rate (promised): 5 Hz · 200 ms; here: 10 Hz · 100 ms."
        ),
        "Blind | sense.eye.scan is not there.\nsense.eye.stop is not there.",
        "Same | Nothing: it is as here.",
    ]
    agreement = make_agreement(view(project.variants["slow"]), "a", "b", standing=("slow",))
    assert describe_standing(agreement.content) == "as it stands in slow"
    assert ("Variant", "as it stands in slow") in [(name, text(value)) for name, value in agreement.outline.facts]
    assert list(list_variant_differences(AgreementChanges(""))) == []
