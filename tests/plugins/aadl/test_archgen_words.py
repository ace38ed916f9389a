"""What an export of archgen's says in AADL is taken back."""

from __future__ import annotations

from pathlib import Path

from tests.plugins.aadl.aadl_texts import import_package, import_text, merge_slices, tell_notes

MODEL = """
property set archgen is
  Id: aadlstring applies to (all);
end archgen;
package r
public
  data Laser_scan extends sensor_msgs::LaserScan
    properties
      archgen::Id => "Laser scan";
      archgen::Description => "720 beams";
      archgen::Status => "planned";
      Data_Size => 5800 Bytes;
  end Laser_scan;
  data Pose end Pose;
  data implementation Pose.impl
    subcomponents
      x: data Base_Types::Float_64 {archgen::Unit_Name => "m"; archgen::Default_Value => "0.5";};
      names: data Base_Types::String {archgen::Field_Type => "string[<=4]";};
  end Pose.impl;
  process lidar_driver
    features
      light: in data port {archgen::Medium => "physical"; archgen::External_End => "The walls %28grey%29";};
      scan: out data port Laser_scan {topic_properties::Default_Name => "/scan";};
    properties
      archgen::Id => "lidar";
      archgen::Title => "The lidar";
      archgen::Functionality => "Measures";
      archgen::Node => "driver";
      archgen::Node_Title => "The driver";
      archgen::Node_Kind => "lifecycle, composable";
      archgen::Package_Name => "lidar_driver";
      archgen::Executable_Name => "driver_node";
  end lidar_driver;
  process implementation lidar_driver.impl
    subcomponents t: thread t;
    connections c: port t.scan -> scan;
    properties
      archgen::Rate => "15 Hz" applies to t;
      Period => 66666666666 ps applies to t;
      Compute_Execution_Time => 0 ns .. 2 ms applies to t;
  end lidar_driver.impl;
  thread t features scan: out data port Laser_scan; end t;
  process reader
    features
      all_scan: in event data port Laser_scan {archgen::Id => "all_data";};
      all_pose: in event data port Pose {archgen::Id => "all_data";};
  end reader;
  process poser features pose: out data port Pose; end poser;
  processor cpu properties archgen::Cores => 4; archgen::Scheduling => "fifo"; end cpu;
  virtual processor fast properties archgen::Container => "fast_box"; archgen::Threads => 2; end fast;
  system sensing features scan: out data port Laser_scan; end sensing;
  system implementation sensing.impl
    subcomponents lidar_x: process lidar_driver.impl;
    connections c: port lidar_x.scan -> scan;
    properties archgen::Title => "What it senses";
  end sensing.impl;
  system acting features scan: in event data port Laser_scan; end acting;
  system implementation acting.impl
    subcomponents reader: process reader; poser: process poser;
    connections c: port scan -> reader.all_scan; d: port poser.pose -> reader.all_pose;
  end acting.impl;
  system robot properties archgen::Title => "A robot"; end robot;
  system implementation robot.launch
    subcomponents
      sensing: system sensing.impl; acting_x: system acting.impl {archgen::Id => "acting";};
      pc: processor cpu; box: virtual processor fast;
    connections c: port sensing.scan -> acting_x.scan {topic_properties::Name => "/scan";};
    flows see_x: end to end flow sensing.f -> c -> acting_x.f {Latency => 0 ns .. 400 ms;};
    properties
      archgen::Flow_Ways => ("see_x: sensing.lidar, acting.reader");
      archgen::Flow_Ids => ("see_x: see");
      archgen::Flow_Titles => ("see_x: See: it");
      Actual_Processor_Binding => (reference (pc)) applies to box, sensing.lidar_x;
      Actual_Processor_Binding => (reference (box)) applies to acting_x.reader;
  end robot.launch;
end r;
"""


def test_a_model_of_archgen(tmp_path: Path) -> None:
    imported = import_text(tmp_path, MODEL)
    assert imported.title == "A robot"
    assert merge_slices(imported) == {
        "types": {
            "Laser scan": {
                "message": "sensor_msgs/msg/LaserScan",
                "comment": "720 beams",
                "status": "planned",
                "size": "5800 B",
            },
            "Pose": {"fields": {"x": {"type": "float64", "default": "0.5", "unit": "m"}, "names": "string[<=4]"}},
        },
        "groups": {
            "sensing": {
                "title": "What it senses",
                "components": {
                    "lidar": {
                        "timing": {"rate": "15 Hz", "wcet": "2 ms"},
                        "inputs": {"light": {"medium": "physical", "external": "The walls (grey)"}},
                        "outputs": {"scan": {"type": "Laser scan"}},
                        "title": "The lidar",
                        "functionality": "Measures",
                    }
                },
            },
            "acting": {
                "components": {
                    "reader": {"inputs": {"all_data": {"from": ["acting.poser.pose", "sensing.lidar.scan"]}}},
                    "poser": {"outputs": {"pose": {"type": "Pose"}}},
                }
            },
        },
        "nodes": {
            "driver": {
                "implements": "sensing.lidar",
                "publishes": {"scan": {"topic": "/scan"}},
                "title": "The driver",
                "kind": ["lifecycle", "composable"],
                "package": "lidar_driver",
                "executable": "driver_node",
                "host": "pc",
            },
            "reader": {"implements": "acting.reader", "container": "fast_box"},
            "poser": {"implements": "acting.poser"},
        },
        "hosts": {"pc": {"scheduling": "fifo", "cores": 4}},
        "containers": {"fast_box": {"host": "pc", "threads": 2}},
        "chains": {"see": {"through": ["sensing.lidar", "acting.reader"], "title": "See: it", "deadline": "400 ms"}},
    }


def test_bytes_are_decoded(tmp_path: Path) -> None:
    properties = 'archgen::Title => "%22a%22 h%C3%B6he %zz %FF";'
    imported = import_package(tmp_path, f"process p features x: out data port; properties {properties} end p;")
    assert merge_slices(imported)["component_types"]["p"]["title"] == '"a" höhe %zz \ufffd'


def test_what_no_field_and_no_thread_can_have_is_not_taken(tmp_path: Path) -> None:
    text = MODEL.replace('=> "0.5"', '=> "half"').replace('"15 Hz"', '"15 z"')
    imported = import_text(tmp_path, text)
    assert "half" not in str(imported.slices)
    assert "15 z" not in str(imported.slices)
    told = [note for note in tell_notes(imported) if "none of its type" in note or "is no rate" in note]
    assert len(told) == text.count("15 z") + 1


def test_an_id_that_is_none_is_made_one(tmp_path: Path) -> None:
    port = 'x: out data port {archgen::Id => "No id: {a}";};'
    imported = import_package(tmp_path, f"process p features {port} end p;")
    assert [*merge_slices(imported)["component_types"]["p"]["outputs"]] == ["no_id_a"]


def test_a_medium_that_is_none_is_not_taken(tmp_path: Path) -> None:
    port = 'x: out data port {archgen::Medium => "smoke";}; y: out data port {archgen::Medium => "can";};'
    imported = import_package(tmp_path, f"process p features {port} end p;")
    outputs = merge_slices(imported)["component_types"]["p"]["outputs"]
    assert "medium" not in str(outputs["x"])
    assert outputs["y"]["medium"] == "can"
    assert any("this is no medium" in note for note in tell_notes(imported))
