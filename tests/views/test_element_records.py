"""The record of each kind of element: what is known, in plain data, and nothing else."""

from __future__ import annotations

import pytest

from archgen import pipeline
from archgen.views.lookup import Lookup, make_lookup
from archgen.views.records.resolved_record import make_record, write_record, write_section

ROBOT = """\
archgen: 1
project: {id: robot}
ros: {distro: jazzy}
groups:
  g:
    components:
      camera: {outputs: {image: {type: Image, description: Rectified.}}, frames: {lens: {parent: base, static: true}}}
      eye: {inputs: {image: {from: camera.image, freshness: 40 ms}}, outputs: {seen: Image}}
types: {Image: sensor_msgs/msg/Image}
frames: {base: {rate: 20 Hz}}
hosts: {pc: {cores: 2, scheduling: {0: fifo}}, arm_pc: }
containers: {box: {host: pc, threads: 2, namespace: /eyes}, bare: {host: pc}}
resources: {bus: {host: pc}}
links: {lan: {connects: [pc, arm_pc], bandwidth: 1 Mbit/s, latency: {best: 1 ms, worst: 2 ms}}}
nodes:
  see: {implements: eye, container: box, timing: {rate: 10 Hz}}
"""


@pytest.fixture(scope="module")
def lookup(tmp_path_factory: pytest.TempPathFactory) -> Lookup:
    file = tmp_path_factory.mktemp("robot") / "robot.yaml"
    file.write_text(ROBOT, encoding="utf-8")
    return make_lookup(pipeline.check_project(file).architecture)


def test_a_component_with_its_ports_and_nodes(lookup: Lookup) -> None:
    record = write_record("component", lookup.architecture.components["g.eye"], lookup)
    assert record == {
        "title": "Eye",
        "group": "g",
        "inputs": {
            "image": {
                "id": "g.eye.image",
                "medium": "digital",
                "freshness": {"text": "40 ms", "value": 40_000_000, "unit": "ns"},
                "sources": ["g.camera.image"],
            }
        },
        "outputs": {
            "seen": {"id": "g.eye.seen", "type": "Image", "medium": "digital", "message": "sensor_msgs/msg/Image"}
        },
        "nodes": ["see"],
    }


def test_an_output_names_who_reads_it(lookup: Lookup) -> None:
    record = write_record("component", lookup.architecture.components["g.camera"], lookup)
    assert record["outputs"] == {
        "image": {
            "id": "g.camera.image",
            "type": "Image",
            "medium": "digital",
            "description": "Rectified.",
            "message": "sensor_msgs/msg/Image",
            "readers": ["g.eye.image"],
        }
    }


def test_a_project_without_composition_has_no_section_of_it(lookup: Lookup) -> None:
    assert not {"composed", "component_types"} & make_record(lookup).keys()


def test_a_host_says_the_order_of_single_cores(lookup: Lookup) -> None:
    assert write_section("hosts", lookup) == {
        "pc": {"title": "Pc", "cores": 2, "scheduling": {"0": "fifo"}},
        "arm_pc": {"title": "Arm Pc"},
    }


def test_the_root_namespace_of_a_container_is_left_out(lookup: Lookup) -> None:
    assert write_section("containers", lookup) == {
        "box": {"title": "Box", "host": "pc", "threads": 2, "namespace": "/eyes"},
        "bare": {"title": "Bare", "host": "pc"},
    }


def test_links_and_resources(lookup: Lookup) -> None:
    assert write_section("links", lookup) == {
        "lan": {
            "title": "Lan",
            "connects": ["pc", "arm_pc"],
            "bandwidth": {"text": "1 Mbit/s", "value": 1_000_000, "unit": "bit/s"},
            "best": {"text": "1 ms", "value": 1_000_000, "unit": "ns"},
            "worst": {"text": "2 ms", "value": 2_000_000, "unit": "ns"},
        }
    }
    assert write_section("resources", lookup) == {"bus": {"title": "Bus", "host": "pc"}}


def test_frames_of_the_project_and_of_components(lookup: Lookup) -> None:
    assert write_section("frames", lookup) == {
        "base": {"title": "base", "rate": {"text": "20 Hz", "value": 20, "unit": "Hz"}},
        "lens": {"title": "lens", "parent": "base", "by": "g.camera", "static": True},
    }


def test_a_node_says_whether_it_is_written(lookup: Lookup) -> None:
    written, derived = (write_record("node", lookup.architecture.nodes[name], lookup) for name in ("see", "camera"))
    assert [each["use"] for each in written.pop("endpoints")] == ["publishes", "subscribes"]  # type: ignore[attr-defined]
    assert written == {
        "title": "See",
        "name": "see",
        "namespace": "/",
        "full_name": "/see",
        "kind": ["node"],
        "container": "box",
        "host": "pc",
        "implements": ["g.eye"],
        "timing": {"g.eye": {"rate": {"text": "10 Hz", "value": 10, "unit": "Hz"}}},
    }
    assert (derived["derived"], derived["status"]) == (True, "planned")
