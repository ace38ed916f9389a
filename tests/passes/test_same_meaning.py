"""Passes that change how a project is written leave what it means: connections, findings with their places, timing."""

from __future__ import annotations

from pathlib import Path

import pytest
import yaml

from archgen.pipeline import transform_project
from tests.judged_projects import judge_ramcip, judge_shipped
from tests.passes.same_meaning import EXAMPLES, check_packed, pack, transform_alike, write_project
from tests.property_sizes import try_some

ALL = ("connect_components", "connect_ports", "connect_types", "resolve_instances", "remove_generics")


@pytest.mark.parametrize("example", try_some(["cleaning_robot", "arm", "vehicle/two_lasers", "bringup", "drone"]))
def test_the_examples(example: str, tmp_path: Path) -> None:
    checked = judge_shipped(EXAMPLES / example)
    for name in ALL:
        transform_alike(checked, name)
    transformed = transform_alike(checked, *ALL)
    check_packed(transformed, tmp_path)
    assert "component_types" not in transformed.merged_table.entries


def test_ramcip(tmp_path: Path) -> None:
    checked = judge_ramcip()
    transformed = transform_alike(checked, *ALL)
    check_packed(transformed, tmp_path)


FEEDING = """\
component_types:
  source: {outputs: {image: Pose, map: Map}}
  pair:
    inputs: {map: Map}
    outputs: {pose: {}}
    autoconnect: ports
    components:
      left: {is: reader, from: [eye, self.map]}
      eye: {is: source}
      made: {inputs: {}, outputs: {pose: Pose}}
  reader: {inputs: {image: Pose, map: Map}}
  unused: {autoconnect: types, components: {a: {is: source}, b: {is: reader}}}
groups:
  g:
    components:
      eye: {is: source}
      two: {is: reader, from: eye}
      pair: {is: pair, inputs: {map: eye.map}}
      strange: {is: pair, inputs: {map: eye.map}, components: {eye: {is: blind}}}
  h:
    components: {three: {is: reader, from: g}}
types: {Pose: geometry_msgs/msg/PoseStamped, Map: nav_msgs/msg/OccupancyGrid}
"""


def test_what_instances_take_is_written_where_they_are_written(tmp_path: Path) -> None:
    text = FEEDING.replace(", self.map]", "]").replace("blind", "source")
    transformed = transform_alike(write_project(tmp_path, text), "connect_components", "connect_ports", "connect_types")
    data = yaml.safe_load(pack(transformed))
    assert data["groups"]["g"]["components"]["two"] == {
        "is": "reader",
        "inputs": {"image": {"from": ["eye.image"]}, "map": {"from": ["eye.map"]}},
    }
    # From another group they are written with their whole paths. What `pair.pose` is, is not known before ports are joined.
    assert data["groups"]["h"]["components"]["three"]["inputs"] == {
        "image": {"from": ["g.eye.image"]},
        "map": {"from": ["g.eye.map"]},
    }
    pair = data["component_types"]["pair"]
    assert "autoconnect" not in pair
    assert pair["components"]["left"]["inputs"] == {"image": {"from": ["eye.image"]}, "map": {"from": ["eye.map"]}}
    assert pair["outputs"]["pose"] == {"from": ["made.pose"]}
    # Nobody uses this type, and what follows in it follows all the same.
    assert data["component_types"]["unused"]["components"]["b"]["inputs"] == {
        "image": {"from": ["a.image"]},
        "map": {"from": ["a.map"]},
    }


def test_where_several_fit_nothing_is_written_and_it_is_told_as_before(tmp_path: Path) -> None:
    checked = write_project(
        tmp_path,
        "groups: {g: {autoconnect: types, components: {a: {outputs: {x: P, y: P}}, b: {inputs: {z: {type: P}}}}}}\n"
        "types: {P: geometry_msgs/msg/Pose}\n",
    )
    assert "ambiguous-connection" in {each.rule for each in checked.findings}
    transformed = transform_alike(checked, "connect_types")
    assert yaml.safe_load(pack(transformed))["groups"]["g"]["autoconnect"] == "types"


DIFFERENT = """\
component_types:
  eye: {outputs: {seen: P}}
  strange_eye: {outputs: {seen: P, other: Q}}
  reader: {inputs: {seen: {type: P, optional: true}, other: {type: Q, optional: true}}}
  pair: {autoconnect: ports, components: {eye: {is: eye}, reader: {is: reader}}}
groups:
  g:
    components:
      plain: {is: pair}
      strange: {is: pair, components: {eye: {is: strange_eye}}}
types: {P: geometry_msgs/msg/Pose, Q: geometry_msgs/msg/Point}
"""


def test_where_instances_of_a_type_differ_each_says_its_own(tmp_path: Path) -> None:
    transformed = transform_alike(write_project(tmp_path, DIFFERENT), "connect_ports")
    data = yaml.safe_load(pack(transformed))
    assert data["component_types"]["pair"]["components"]["reader"]["inputs"] == {"seen": {"from": ["eye.seen"]}}
    assert data["groups"]["g"]["components"]["strange"]["components"]["reader"] == {
        "inputs": {"other": {"from": ["eye.other"]}}
    }


def test_an_instance_says_everything_itself_and_each_part_where_it_is_from(tmp_path: Path) -> None:
    checked = write_project(
        tmp_path,
        "component_types:\n  base: {tags: [fast], outputs: {x: P}}\n  eye: {is: base, title: Eye, role: source}\n"
        "groups:\n  g: {components: {left: {is: eye, role: reactive, tags: [new]}}}\ntypes: {P: geometry_msgs/msg/Pose}\n",
    )
    transformed = transform_alike(checked, "resolve_instances")
    data = yaml.safe_load(pack(transformed))
    left = {"tags": ["fast", "new"], "outputs": {"x": {"type": "P"}}, "role": "reactive"}
    assert data["groups"] == {"g": {"components": {"left": left}}}
    assert transformed.transformed is not None
    path = ("groups", "g", "components", "left")
    origins = transformed.transformed.provenance
    assert origins[*path, "outputs"].path == ("component_types", "base", "outputs")
    assert origins[*path, "outputs"].passes == ("resolve_instances",)
    assert (*path, "role") not in origins


GENERIC = """\
component_types:
  filter: {title: Filter, generic: [T], inputs: {raw: T}, outputs: {clean: Envelope<T>}}
  chain:
    generic: [T]
    inputs: {raw: T}
    outputs: {clean: {from: two.clean}}
    components: {one: {is: filter<T>, inputs: {raw: self.raw}}, two: {is: filter<Envelope<T>>, inputs: {raw: one.clean}}}
  filter_of_pose: {outputs: {x: pose}}
groups:
  g:
    components:
      a: {outputs: {o: Pose, l: "List<Envelope<Pose>>"}}
      f: {is: filter<Pose>, inputs: {raw: a.o}}
      c: {is: chain<Pose>, inputs: {raw: a.o}}
      own: {is: filter_of_pose}
      s: {inputs: {v: f.clean, w: c.clean, l: a.l, x: own.x}}
types:
  Pose: geometry_msgs/msg/PoseStamped
  pose: geometry_msgs/msg/Pose
  Envelope: {generic: [T], fields: {sender: string, payload: T}}
  List: {generic: [T], fields: {items: "T[]"}}
  Envelope<Pose>: {message: my_msgs/msg/Parcel}
  Bag: {fields: {all: "Envelope<pose>[<=4]"}}
"""


def test_each_combination_of_types_becomes_a_type_of_its_own(tmp_path: Path) -> None:
    checked = write_project(tmp_path, GENERIC)
    transformed = transform_alike(checked, "remove_generics")
    check_packed(transformed, tmp_path / "packed")
    data = yaml.safe_load(pack(transformed))
    # What is called alike already keeps its name.
    assert list(data["component_types"]) == [
        "filter_of_pose",
        "filter_of_pose_2",
        "chain_of_pose",
        "filter_of_envelope_of_pose",
    ]
    assert data["component_types"]["chain_of_pose"]["components"]["two"]["is"] == "filter_of_envelope_of_pose"
    assert data["types"]["Envelope of Pose"]["message"] == "my_msgs/msg/Parcel"
    assert data["types"]["List of Envelope of Pose"]["fields"] == {"items": {"type": "Envelope of Pose[]"}}
    assert data["types"]["Bag"]["fields"] == {"all": {"type": "Envelope of pose[<=4]"}}
    assert "<" not in pack(transformed).replace("[<=4]", "")
    messages = {each.message for each in checked.architecture.types.values() if each.message and not each.generic}
    assert {each.message for each in transformed.architecture.types.values() if each.message} == messages


def test_types_of_libraries_are_made_beside_theirs(tmp_path: Path) -> None:
    transformed = transform_project(judge_shipped(EXAMPLES / "vehicle" / "scenario"), ["remove_generics"])
    check_packed(transformed, tmp_path)
