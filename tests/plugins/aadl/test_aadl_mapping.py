"""What AADL says becomes components, types, nodes, hosts, links and chains."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from archgen.diagnostics.diagnostic import Severity
from archgen.importers.foreign_import import ForeignFileError
from archgen.plugins.aadl.aadl_import import read_aadl
from archgen.syntax.yaml_writer import write_yaml
from tests.judged_projects import check_text
from tests.plugins.aadl.aadl_texts import import_package, merge_slices, tell_notes


def map_package(folder: Path, body: str) -> dict[str, Any]:
    """Return the sections of a package, without the hints of where each thing was."""
    imported = import_package(folder, body)
    sections = merge_slices(imported)
    findings = check_text("archgen: 1\n" + write_yaml(sections))
    assert [finding.message for finding in findings if finding.effective_severity is Severity.ERROR] == []
    return drop_hints(sections)


def drop_hints(data: dict[str, Any]) -> dict[str, Any]:
    """Return data of the language without its hints."""
    return {
        key: drop_hints(value) if isinstance(value, dict) else value for key, value in data.items() if key != "hints"
    }


def test_a_process_that_stands_twice_is_a_component_type(tmp_path: Path) -> None:
    sections = map_package(
        tmp_path,
        """
        process camera features image: out data port; end camera;
        process stitcher features images: in event data port; end stitcher;
        system robot end robot;
        system implementation robot.i
          subcomponents left: process camera; right: process camera; both: process stitcher;
          connections a: port left.image -> both.images; b: port right.image -> both.images;
          properties
            Period => 40 ms applies to left;
            Dispatch_Protocol => Periodic applies to left;
        end robot.i;
        """,
    )
    assert sections == {
        "component_types": {"camera": {"outputs": {"image": {}}}},
        "groups": {
            "robot": {
                "components": {
                    "left": {"is": "camera", "timing": {"behaviour": "periodic", "period": "40 ms"}},
                    "right": {"is": "camera"},
                    "both": {"inputs": {"images": {"from": ["robot.left.image", "robot.right.image"]}}},
                }
            }
        },
        "nodes": {
            "left": {"implements": "robot.left"},
            "right": {"implements": "robot.right"},
            "both": {"implements": "robot.both"},
        },
    }


def test_what_is_extended_is_a_type_and_what_extends_it_is_made_from_it(tmp_path: Path) -> None:
    sections = map_package(
        tmp_path,
        """
        data Pose end Pose;
        data Fine_Pose extends Pose end Fine_Pose;
        process base features a: in event data port; pose: out data port Pose; end base;
        process fine extends base
          features pose: refined to out data port Fine_Pose; more: out data port Pose;
        end fine;
        """,
    )
    assert sections["component_types"] == {
        "base": {"inputs": {"a": {}}, "outputs": {"pose": {"type": "Pose"}}},
        "fine": {"is": "base", "outputs": {"pose": {"type": "Fine_Pose"}, "more": {"type": "Pose"}}},
    }


def test_a_part_that_is_refined_to_one_with_more_makes_a_type_of_its_own(tmp_path: Path) -> None:
    sections = map_package(
        tmp_path,
        """
        process one features x: out data port; end one;
        process two features x: out data port; y: out data port; end two;
        system s end s;
        system implementation s.i subcomponents p: process one; end s.i;
        system implementation s.j extends s.i subcomponents p: refined to process two; end s.j;
        system all_of end all_of;
        system implementation all_of.i
          subcomponents a: system s.i; b: system s.i; c: system s.j; d: system s.j;
        end all_of.i;
        """,
    )
    assert sections["component_types"]["s_i"] == {"components": {"p": {"outputs": {"x": {}}}}}
    assert sections["component_types"]["s_j"] == {"components": {"p": {"outputs": {"x": {}, "y": {}}}}}


def test_systems_of_systems_are_groups_and_composed_components(tmp_path: Path) -> None:
    sections = map_package(
        tmp_path,
        """
        process origin features x: out data port; end origin;
        process target features y: in event data port; end target;
        system sensing features x: out data port; end sensing;
        system implementation sensing.i
          subcomponents first: process origin;
          connections c: port first.x -> x;
        end sensing.i;
        system inner features y: in event data port; end inner;
        system implementation inner.i
          subcomponents last: process target;
          connections c: port y -> last.y;
        end inner.i;
        system acting features y: in event data port; end acting;
        system implementation acting.i
          subcomponents deep: system inner.i;
          connections c: port y -> deep.y;
        end acting.i;
        system robot features outside: in event data port; end robot;
        system implementation robot.i
          subcomponents sensing: system sensing.i; acting: system acting.i; log: process target;
          connections
            c: port sensing.x -> acting.y;
            d: port outside -> log.y;
        end robot.i;
        """,
    )
    assert sections["groups"] == {
        "sensing": {"components": {"first": {"outputs": {"x": {}}}}},
        "acting": {
            "components": {
                "deep": {
                    "components": {"last": {"is": "target", "inputs": {"y": {"from": ["self.y"]}}}},
                    "inputs": {"y": {"from": ["sensing.first.x"]}},
                }
            }
        },
        "robot": {"components": {"log": {"is": "target", "inputs": {"y": {"external": "outside"}}}}},
    }
    assert sections["nodes"] == {
        "first": {"implements": "sensing.first"},
        "last": {"implements": "acting.deep.last"},
        "log": {"implements": "robot.log"},
    }


def test_feature_groups_are_taken_apart_and_inverse_ones_turned(tmp_path: Path) -> None:
    sections = map_package(
        tmp_path,
        """
        feature group drive features speed: in event data port; state: out data port; end drive;
        feature group driver inverse of drive end driver;
        process motor features d: feature group drive; end motor;
        process planner features d: feature group driver; end planner;
        process viewer features d: feature group inverse of drive; end viewer;
        system robot end robot;
        system implementation robot.i
          subcomponents m: process motor; p: process planner;
          connections c: feature group p.d <-> m.d;
        end robot.i;
        """,
    )
    assert sections["groups"]["robot"]["components"] == {
        "m": {"inputs": {"d_speed": {"from": ["robot.p.d_speed"]}}, "outputs": {"d_state": {}}},
        "p": {"inputs": {"d_state": {"from": ["robot.m.d_state"]}}, "outputs": {"d_speed": {}}},
    }
    assert sections["component_types"]["viewer"] == {"inputs": {"d_state": {}}, "outputs": {"d_speed": {}}}


def test_data_become_types_with_fields_values_and_generics(tmp_path: Path) -> None:
    sections = map_package(
        tmp_path,
        """
        with Base_Types, Data_Model, geometry_msgs;
        data Place end Place;
        data implementation Place.i
          subcomponents x: data Base_Types::Float_64; name: data Base_Types::String; Angles: data Base_Types::Float_32 [3];
        end Place.i;
        data Envelope prototypes payload: data; end Envelope;
        data implementation Envelope.i subcomponents sender: data Base_Types::String; load: data payload; end Envelope.i;
        data Phase properties
          Data_Model::Data_Representation => Enum;
          Data_Model::Enumerators => ("idle", "run");
        end Phase;
        data Box properties
          Data_Model::Data_Representation => Struct;
          Data_Model::Element_Names => ("w", "h");
          Data_Model::Base_Type => (classifier (Base_Types::Unsigned_8), classifier (Place));
        end Box;
        subprogram Add features a: in parameter Place; sum: out parameter Place.i; end Add;
        process p
          features
            at: out data port Place.i;
            twist: out data port geometry_msgs::Twist;
            add: provides subprogram access Add;
        end p;
        """,
    )
    assert sections["types"] == {
        "Place": {"fields": {"x": "float64", "name": "string", "angles": "float32[3]"}},
        "Envelope": {"generic": ["payload"], "fields": {"sender": "string", "load": "payload"}},
        "Phase": {"values": ["IDLE", "RUN"]},
        "Box": {"fields": {"w": "uint8", "h": "Place"}},
        "Add": {"request": {"a": "Place"}, "response": {"sum": "Place"}},
    }
    assert sections["component_types"]["p"]["outputs"] == {
        "at": {"type": "Place"},
        "twist": {"type": "geometry_msgs/msg/Twist"},
        "add": {"type": "Add"},
    }


def test_types_in_none_of_the_files_are_called_as_no_other_one(tmp_path: Path) -> None:
    sections = map_package(
        tmp_path,
        """
        data Pose end Pose;
        data Stamp end Stamp;
        data implementation Stamp.i
          subcomponents at: data Pose; far: data away::Pose; clock: data away::Clock; same: data away::clock;
        end Stamp.i;
        process p features a: out data port Pose; b: out data port away::Pose; c: out data port away::Lamp; end p;
        """,
    )
    fields = {"at": "Pose", "far": "Pose (away)", "clock": "Clock", "same": "Clock"}
    assert sections["types"] == {"Pose": {}, "Stamp": {"fields": fields}, "Pose (away)": {}, "Clock": {}}
    ports = sections["component_types"]["p"]["outputs"]
    assert ports == {"a": {"type": "Pose"}, "b": {"type": "Pose (away)"}, "c": {"type": "Lamp"}}


def test_threads_tell_timing_and_what_fires_them(tmp_path: Path) -> None:
    sections = map_package(
        tmp_path,
        """
        thread worker
          features trigger: in event data port; sampled: in data port; done: out event port;
          properties
            Dispatch_Protocol => Sporadic;
            Deadline => 500 us;
            Compute_Execution_Time => 100000 ns .. 0.25 ms;
            Priority => 7;
        end worker;
        process p features trigger: in event data port; sampled: in data port; done: out event port; end p;
        process implementation p.i
          subcomponents w: thread worker;
          connections
            a: port trigger -> w.trigger;
            b: port sampled -> w.sampled;
            c: port w.done -> done;
        end p.i;
        """,
    )
    assert sections["component_types"]["p"]["timing"] == {
        "behaviour": "event",
        "deadline": "500 us",
        "wcet": "0.25 ms",
        "bcet": "100000 ns",
        "priority": 7,
        "trigger": ["trigger"],
    }


def test_kinds_of_ports_are_kept_where_they_are_not_the_usual_ones(tmp_path: Path) -> None:
    imported = import_package(
        tmp_path,
        """
        process p
          features a: in event data port; b: in data port; c: in event port; d: out data port; e: out event data port;
        end p;
        """,
    )
    ports = merge_slices(imported)["component_types"]["p"]
    kinds = {key: body.get("hints", {}).get("aadl", {}) for key, body in (ports["inputs"] | ports["outputs"]).items()}
    assert kinds == {"a": {}, "b": {"port": "data"}, "c": {"port": "event"}, "d": {}, "e": {"port": "event data"}}


def test_hosts_and_links_of_hardware_anywhere(tmp_path: Path) -> None:
    sections = map_package(
        tmp_path,
        """
        bus CAN properties Latency => 1 ms .. 2 ms; Transmission_Time => [Fixed => 0 us .. 1 us; PerByte => 1 us .. 2 us;]; end CAN;
        processor cpu features b: requires bus access CAN; properties Scheduling_Protocol => (EDF); end cpu;
        system board features b: requires bus access CAN; end board;
        system implementation board.i
          subcomponents cpu: processor cpu;
          connections c: bus access b -> cpu.b;
        end board.i;
        process p features x: out data port; end p;
        process q features x: in event data port; end q;
        system robot end robot;
        system implementation robot.i
          subcomponents
            one: system board.i; two: system board.i; can: bus CAN;
            p: process p; q: process q; r: process q;
          connections
            c1: bus access can -> one.b;
            c2: bus access can -> two.b;
            c3: port p.x -> q.x;
          properties
            Actual_Processor_Binding => (reference (one.cpu)) applies to p;
            Actual_Processor_Binding => (reference (two)) applies to q, r;
        end robot.i;
        """,
    )
    assert sections["hosts"] == {"cpu": {"scheduling": "edf"}, "two_cpu": {"scheduling": "edf"}}
    assert sections["links"] == {
        "can": {
            "connects": ["cpu", "two_cpu"],
            "protocol": "can",
            "latency": {"best": "1 ms", "worst": "2 ms"},
            "bandwidth": "500000 B/s",
        }
    }
    assert {key: node["host"] for key, node in sections["nodes"].items()} == {
        "p": "cpu",
        "q": "two_cpu",
        "r": "two_cpu",
    }


def test_a_flow_through_groups_is_a_chain(tmp_path: Path) -> None:
    sections = map_package(
        tmp_path,
        """
        process p features x: out data port; flows f: flow source x; end p;
        process q features x: in event data port; flows f: flow sink x; end q;
        system sensing features x: out data port; flows f: flow source x; end sensing;
        system implementation sensing.i
          subcomponents p: process p;
          connections c: port p.x -> x;
          flows f: flow source p.f -> c -> x;
        end sensing.i;
        system robot end robot;
        system implementation robot.i
          subcomponents sensing: system sensing.i; q: process q;
          connections c: port sensing.x -> q.x;
          flows whole: end to end flow sensing.f -> c -> q.f {Latency => 5 ms .. 50 ms;};
        end robot.i;
        """,
    )
    assert sections["chains"] == {"whole": {"through": ["sensing.p", "robot.q"], "deadline": "50 ms"}}


def test_ids_are_made_of_names_and_the_names_are_kept(tmp_path: Path) -> None:
    imported = import_package(
        tmp_path,
        """
        process Lidar_2D features PointCloud: out data port; end Lidar_2D;
        system Robot end Robot;
        system implementation Robot.Launch
          subcomponents FrontLidar: process Lidar_2D;
        end Robot.Launch;
        """,
    )
    [(group_id, group)] = merge_slices(imported)["groups"].items()
    [(component_id, component)] = group["components"].items()
    [(port_id, port)] = component["outputs"].items()
    assert (group_id, component_id, port_id) == ("robot", "front_lidar", "point_cloud")
    names = [body["hints"]["aadl"]["name"] for body in (group, component, port)]
    assert names == ["Robot.Launch", "FrontLidar", "PointCloud"]


def test_words_of_archgen_are_taken_back(tmp_path: Path) -> None:
    sections = map_package(
        tmp_path,
        """
        process p features x: out data port; properties archgen::Component_Type => "motor"; end p;
        system robot end robot;
        system implementation robot.i
          subcomponents data_1: process p {archgen::Id => "data"; archgen::Title => "The data"; archgen::Node => "driver";};
        end robot.i;
        """,
    )
    assert list(sections["component_types"]) == ["motor"]
    assert sections["groups"]["robot"]["components"] == {"data": {"is": "motor", "title": "The data"}}
    assert list(sections["nodes"]) == ["driver"]


@pytest.mark.parametrize(
    ("body", "notes"),
    [
        (
            "process p features x: out data port; properties My::Weight => 3; Stack_Size => 1 KByte; end p;",
            [
                "3:49 property My::Weight: the property set my is in none of the files, and archgen has no word for this property",
                "3:66 property Stack_Size: archgen has no word for this property",
            ],
        ),
        (
            "process p features x: out data port; annex EMV2 {** x **}; end p;",
            ["3:38 annex EMV2: the text of annexes is not read"],
        ),
        (
            "process p extends q features x: out data port; end p; process q extends p end q;",
            ["3:1 extends: p::p extends itself in the end; what it extends is left out here"],
        ),
        (
            "system a end a; system implementation a.i subcomponents b: system a.i; end a.i;",
            ["3:57 subcomponent: b is within itself in the end"],
        ),
        (
            "process p features x: out data port; end p; process P features y: in data port; end P;",
            ["3:45 duplicate: p::P is declared a second time, first in m.aadl:3:1; the first counts"],
        ),
        (
            "process p features x: out data port nowhere::Thing; f: feature; end p;",
            ["3:53 feature: feature f has no direction"],
        ),
        (
            (
                "process p features x: out data port; end p; system s end s;\n"
                "system implementation s.i subcomponents p: process p; q: process other; connections c: port p.x -> p.x; end s.i;"
            ),
            [
                "4:55 classifier other: `other` is in none of the files; what is written of it here counts all the same",
                "4:85 connection: connection c joins no output to an input",
            ],
        ),
    ],
)
def test_what_is_not_taken_is_told(tmp_path: Path, body: str, notes: list[str]) -> None:
    imported = import_package(tmp_path, body)
    assert [note.replace(str(tmp_path) + "/", "") for note in tell_notes(imported)] == notes


def test_the_same_property_is_told_once(tmp_path: Path) -> None:
    imported = import_package(
        tmp_path,
        "process p features x: out data port; properties My::W => 3; end p;"
        "process q features x: out data port; properties My::W => 4; end q;",
    )
    [note] = imported.notes
    assert note.message.endswith("(2 places, this is the first)")


def test_files_of_a_model_are_looked_up_in_one_another(tmp_path: Path) -> None:
    (tmp_path / "a.aadl").write_text("package a public data T end T; end a;", encoding="utf-8")
    (tmp_path / "b.aadl").write_text(
        "package b public with a; renames a::all; short renames package a;\n"
        "process p features x: out data port T; y: out data port short::T; end p; end b;",
        encoding="utf-8",
    )
    sections = merge_slices(read_aadl([tmp_path / "b.aadl", tmp_path / "a.aadl"]))
    assert drop_hints(sections["component_types"]["p"]["outputs"]) == {"x": {"type": "T"}, "y": {"type": "T"}}


def test_a_folder_is_the_files_in_it_and_one_without_aadl_stops_no_other(tmp_path: Path) -> None:
    """R16: as the other imports take folders; links are left out, and an empty folder is told."""
    (tmp_path / "model/parts").mkdir(parents=True)
    (tmp_path / "model/empty.aadl").write_text("")
    (tmp_path / "model/notes.txt").write_text("no model")
    (tmp_path / "model/parts/a.aadl").write_text("package P\npublic\n  process lamp\n  end lamp;\nend P;\n")
    (tmp_path / "model/link.aadl").symlink_to(tmp_path / "model/parts/a.aadl")
    imported = read_aadl([tmp_path / "model"])
    assert [(note.kind, Path(note.span.file).name) for note in imported.notes] == [("file", "empty.aadl")]
    assert imported.taken == read_aadl([tmp_path / "model/parts/a.aadl"]).taken
    (tmp_path / "none").mkdir()
    with pytest.raises(ForeignFileError, match=r"no file in it is called `\.aadl`"):
        read_aadl([tmp_path / "none"])
