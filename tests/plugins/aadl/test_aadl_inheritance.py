"""What a classifier has from its type, from what it extends and from what is around it counts in AADL's order."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from tests.plugins.aadl.aadl_texts import import_package, merge_slices, tell_notes

IN_A_ROBOT = """
process program features x: in event data port; end program;
process implementation program.i
  subcomponents worker: thread fine.i;
  connections c: port x -> worker.x;
end program.i;
system robot end robot;
system implementation robot.i subcomponents program: process program.i; end robot.i;
"""


def import_program(folder: Path, body: str) -> dict[str, Any]:
    """Return the component that the process `program` of the only group became."""
    component: dict[str, Any] = merge_slices(import_package(folder, body))["groups"]["robot"]["components"]["program"]
    return component


def test_the_own_type_counts_before_the_type_of_what_an_implementation_extends(tmp_path: Path) -> None:
    body = """
    thread base features x: in data port; properties Dispatch_Protocol => Sporadic; Deadline => 20 ms; Priority => 1; end base;
    thread implementation base.i properties Compute_Execution_Time => 3 ms; Priority => 2; end base.i;
    thread fine extends base
      features x: refined to in event data port;
      properties Deadline => 10 ms; Priority => 3; Compute_Execution_Time => 9 ms;
    end fine;
    thread implementation fine.i extends base.i end fine.i;
    """
    timing = import_program(tmp_path, body + IN_A_ROBOT)["timing"]
    assert timing == {"behaviour": "event", "deadline": "10 ms", "priority": 2, "wcet": "3 ms"}


def test_a_list_goes_on_behind_the_one_that_is_inherited(tmp_path: Path) -> None:
    imported = import_package(
        tmp_path,
        """
        process program features x: out data port; properties Source_Text => ("a.h"); end program;
        process implementation program.i properties Source_Text +=> ("b.h"); Source_Text +=> ("c.h"); end program.i;
        system robot end robot;
        system implementation robot.i subcomponents program: process program.i; end robot.i;
        """,
    )
    hints = merge_slices(imported)["groups"]["robot"]["components"]["program"]["hints"]["aadl"]
    assert hints["source_text"] == ["a.h", "b.h", "c.h"]
    assert imported.notes == ()


@pytest.mark.parametrize(
    ("thread", "around", "timing"),
    [
        (
            "Dispatch_Protocol => Periodic;",
            "Period => 5 ms; Priority => 4;",
            {"behaviour": "periodic", "period": "5 ms", "priority": 4},
        ),
        (
            "Dispatch_Protocol => Periodic; Period => 9 ms;",
            "Period => 5 ms;",
            {"behaviour": "periodic", "period": "9 ms"},
        ),
        ("Dispatch_Protocol => Sporadic;", "Period => 5 ms;", {"behaviour": "event"}),
    ],
)
@pytest.mark.parametrize("count", [1, 2])
def test_a_system_hands_its_period_down(
    tmp_path: Path, thread: str, around: str, timing: dict[str, Any], count: int
) -> None:
    body = f"""
    thread fine features x: in event data port; properties {thread} end fine;
    thread implementation fine.i end fine.i;
    {IN_A_ROBOT}
    """
    parts = " ".join(f"p{index}: process program.i;" for index in range(count))
    body = body.replace("program: process program.i;", f"{parts} properties {around}")
    sections = merge_slices(import_package(tmp_path, body))
    component = sections["groups"]["robot"]["components"]["p0"]
    own_type = sections.get("component_types", {}).get(component.get("is"), {})
    assert own_type.get("timing", {}) | component.get("timing", {}) == timing


def test_what_a_type_says_of_its_parts_is_not_said_again_at_instances(tmp_path: Path) -> None:
    sections = merge_slices(
        import_package(
            tmp_path,
            """
            thread quick features x: in event data port; properties Dispatch_Protocol => Sporadic; end quick;
            thread slow features x: in event data port; properties Dispatch_Protocol => Periodic; end slow;
            process p features x: in event data port; end p;
            process implementation p.i
              subcomponents a: thread quick; b: thread slow {Period => 9 ms;}; c: thread slow;
              connections port x -> a.x; port x -> b.x; port x -> c.x;
            end p.i;
            system s end s;
            system implementation s.i
              subcomponents one: process p.i; two: process p.i;
              properties Period => 5 ms; Priority => 3 applies to one.a;
            end s.i;
            """,
        )
    )
    components = sections["groups"]["s"]["components"]
    late = {"c": {"timing": {"period": "5 ms"}}}
    assert components["one"]["components"] == {"a": {"timing": {"priority": 3}}, **late}
    assert components["two"]["components"] == late
    [own_type] = [each for each in sections["component_types"].values() if "components" in each]
    assert own_type["components"]["b"]["timing"]["period"] == "9 ms"


def test_a_program_is_bound_in_the_braces_of_its_subcomponent(tmp_path: Path) -> None:
    imported = import_package(
        tmp_path,
        """
        process program features x: in event data port; end program;
        processor cpu end cpu;
        system robot end robot;
        system implementation robot.i
          subcomponents program: process program {Actual_Processor_Binding => (reference (pc));}; pc: processor cpu;
        end robot.i;
        """,
    )
    assert merge_slices(imported)["nodes"] == {"program": {"implements": "robot.program", "host": "pc"}}


@pytest.mark.parametrize(
    ("properties", "latency"),
    [
        ("Transmission_Time => [Fixed => 1 ms .. 2 ms;];", {"best": "1 ms", "worst": "2 ms"}),
        ("Latency => 3 ms .. 4 ms; Transmission_Time => [Fixed => 1 ms .. 2 ms;];", {"best": "3 ms", "worst": "4 ms"}),
        ("Transmission_Time => [Fixed => 0 ms .. 0 ms;];", None),
    ],
)
def test_what_each_message_takes_on_a_bus_is_its_latency(
    tmp_path: Path, properties: str, latency: dict[str, str] | None
) -> None:
    imported = import_package(
        tmp_path,
        f"""
        bus wire properties {properties} end wire;
        processor cpu features net: requires bus access wire; end cpu;
        system robot end robot;
        system implementation robot.i
          subcomponents one: processor cpu; two: processor cpu; net: bus wire;
          connections a: bus access net -> one.net; b: bus access net -> two.net;
        end robot.i;
        """,
    )
    assert merge_slices(imported)["links"]["net"].get("latency") == latency


def test_what_is_taken_elsewhere_is_told_where_it_is_not(tmp_path: Path) -> None:
    imported = import_package(
        tmp_path,
        """\
process p features x: out data port; y: in data port; end p;
system s end s;
system implementation s.i
  subcomponents p: process p; q: process p;
  connections c: port p.x -> q.y {Latency => 1 ms;};
end s.i;
properties
  Stack_Size => 2 KByte;
""",
    )
    assert tell_notes(imported) == [
        "7:35 property Latency: it is not taken here: what it is said of is used nowhere, or has no word for it",
        "10:3 property Stack_Size: archgen has no word for this property",
    ]


def test_a_step_of_a_flow_that_leads_nowhere_is_told(tmp_path: Path) -> None:
    imported = import_package(
        tmp_path,
        """
        process p features x: out data port; flows f: flow source x; end p;
        process q features x: in data port; flows f: flow sink x; end q;
        system s end s;
        system implementation s.i
          subcomponents p: process p; q: process q;
          connections c: port p.x -> q.x;
          flows e: end to end flow p.f -> c -> gone.f -> c -> q.f;
        end s.i;
        """,
    )
    assert tell_notes(imported) == [
        "10:17 end to end flow: step gone.f of flow e is neither a part nor a connection; it is left out"
    ]
    assert merge_slices(imported)["chains"] == {"e": {"through": ["s.p", "s.q"]}}
