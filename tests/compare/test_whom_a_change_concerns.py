"""Whom a change concerns: everybody who is affected by it, and nobody else."""

from __future__ import annotations

import pytest

from tests.compare.conftest import Compared
from tests.property_sizes import try_some

HARVESTER = """\
archgen: 1
project: {id: harvester, title: Harvester}
partners: {vega: Vega, orsa: Orsa, palma: Palma, kite: Kite}
ros: {distro: jazzy}
requirements: {R-1: Sees rows, R-5: Stops for people}
hosts: {front: {cores: 2, scheduling: fixed_priority}, rear: {cores: 2, scheduling: fixed_priority}, arm: {cores: 1, scheduling: fixed_priority}}
links: {lan: {connects: [front, rear, arm], bandwidth: 100 Mbit/s}}
types:
  Scan: {message: sensor_msgs/msg/LaserScan, size: 10 kB}
  Rows: {message: geometry_msgs/msg/PoseArray, size: 2 kB}
  Persons: {message: geometry_msgs/msg/PoseArray, size: 1 kB}
  Speed: geometry_msgs/msg/Twist
  Pose: geometry_msgs/msg/Pose
  Stop: std_msgs/msg/Bool
groups:
  sensing:
    owner: vega
    components:
      lidar: {timing: {rate: 10 Hz, wcet: 5 ms}, outputs: {scan: Scan}}
      finder: {timing: {trigger: [scan], wcet: 10 ms}, requirements: [R-1], inputs: {scan: lidar.scan}, outputs: {rows: {type: Rows, description: In metres}}}
      detector: {timing: {trigger: [scan], wcet: 10 ms}, requirements: [R-5], inputs: {scan: lidar.scan}, outputs: {persons: Persons}}
  navigation:
    owner: orsa
    components:
      ekf: {timing: {rate: 50 Hz, wcet: 2 ms}, inputs: {rows: finder.rows}, outputs: {pose: Pose}}
      limiter: {timing: {trigger: [persons], wcet: 1 ms}, requirements: [R-5], inputs: {persons: detector.persons, pose: ekf.pose}, outputs: {speed: Speed}}
  manipulation:
    owner: palma
    components:
      planner: {timing: {rate: 5 Hz, wcet: 20 ms}, inputs: {pose: ekf.pose}, outputs: {grasp: Pose}}
      driver: {timing: {trigger: [grasp], wcet: 1 ms}, inputs: {grasp: planner.grasp}, outputs: {torque: {type: Torque, external: Arm, medium: physical}}}
  supervision:
    owner: kite
    components:
      supervisor: {timing: {trigger: [persons], wcet: 1 ms}, requirements: [R-5], inputs: {persons: detector.persons, speed: limiter.speed}, outputs: {stop: Stop}}
      ui: {timing: {rate: 1 Hz, wcet: 1 ms}, inputs: {stop: supervisor.stop}, outputs: {light: {type: Light, external: Lamp, medium: physical}}}
nodes:
  lidar_node: {implements: lidar, host: front}
  finder_node: {implements: finder, host: front, publishes: {rows: {qos: {reliability: best_effort}}}}
  detector_node: {implements: detector, host: front}
  ekf_node: {implements: ekf, host: rear, subscribes: {rows: {qos: {reliability: best_effort}}}}
  limiter_node: {implements: limiter, host: rear}
  planner_node: {implements: planner, host: arm}
  driver_node: {implements: driver, host: arm}
  supervisor_node: {implements: supervisor, host: rear}
  ui_node: {implements: ui, host: rear}
chains: {halt: {through: [lidar, detector, supervisor], deadline: 400 ms}}
"""
DETECTOR = next(line for line in HARVESTER.splitlines(keepends=True) if line.startswith("      detector:"))
ALL = "kite orsa palma vega"
CASES = {
    # Everybody who is affected.
    "a rate is halved": ([("rate: 10 Hz", "rate: 5 Hz")], "kite orsa vega"),
    "a producer is given to its reader": ([("detector: {", "detector: {owner: kite, ")], "kite orsa vega"),
    "a group is given to another partner": ([("owner: vega", "owner: palma")], ALL),
    "a component is moved into another's group, its owner kept": (
        [(DETECTOR, ""), ("      planner: {", DETECTOR.replace("{", "{owner: vega, ", 1) + "      planner: {")],
        ALL,
    ),
    "a component is moved into another's group": (
        [(DETECTOR, ""), ("      planner: {", DETECTOR + "      planner: {")],
        ALL,
    ),
    "a node is moved to a host of others": (
        [("planner, host: arm", "planner, host: rear")],
        ALL,
    ),
    "an output comes only now and then": (
        [("detector: {timing: {", "detector: {timing: {outputs: {persons: {conditional: true}}, ")],
        "kite orsa vega",
    ),
    "the meaning of an output is another": ([("In metres", "In millimetres")], "orsa vega"),
    "a component is renamed, and the readers' files with it": (
        [("detector", "spotter")],
        "kite orsa vega",
    ),
    "a requirement is deleted with its references": (
        [(", R-5: Stops for people", ""), ("requirements: [R-5], ", "")],
        "kite orsa vega",
    ),
    "a reader asks for what is not offered": (
        [("rows: {qos: {reliability: best_effort}}}}\n  limiter", "rows: {qos: {reliability: reliable}}}}\n  limiter")],
        "orsa vega",
    ),
    "a new reader asks for what is not offered": (
        [
            ("planner: {timing: {rate: 5 Hz, wcet: 20 ms}, inputs: {", "planner: {timing: {rate: 5 Hz, wcet: 20 ms}, inputs: {rows: finder.rows, "),
            ("planner_node: {", "planner_node: {subscribes: {rows: {qos: {reliability: reliable}}}, "),
        ],
        "palma vega",
    ),
    "a message is larger": ([("size: 1 kB", "size: 500 kB")], ALL),
    "a distribution": ([("jazzy", "humble")], ALL),
    "work on a shared host takes longer": ([("limiter: {timing: {trigger: [persons], wcet: 1 ms", "limiter: {timing: {trigger: [persons], wcet: 9 ms")], ALL),
    "a host loses a core": ([("arm: {cores: 1, scheduling: fixed_priority}", "arm: {cores: 2, scheduling: fixed_priority}")], "palma"),
    "a link is slower": ([("100 Mbit/s", "10 Mbit/s")], "kite orsa palma vega"),
    "a link reaches a host no longer": ([("[front, rear, arm]", "[front, rear]")], ALL),
    "a deadline is relaxed": ([("400 ms", "500 ms")], "kite vega"),
    "a type has another message": ([("Speed: geometry_msgs/msg/Twist", "Speed: geometry_msgs/msg/TwistStamped")], "kite orsa"),
    "an output is gone": ([(", outputs: {speed: Speed}", ""), (", speed: limiter.speed", "")], "kite orsa"),
    "a topic has another name": ([("limiter_node: {", "limiter_node: {publishes: {speed: /slow}, ")], "kite orsa"),
    "a component is shared": ([("ekf: {", "ekf: {owner: [orsa, palma], ")], "orsa palma vega"),
    "a partner is called otherwise": ([("palma: Palma", "palma: Palma Arms")], "palma"),
    "an input is optional now": ([("speed: limiter.speed}", "speed: {from: limiter.speed, optional: true}}")], "kite orsa"),
    "a promised accuracy": (
        [("finder: {", "finder: {performance: {rows: {accuracy: 90 % of rows}}, ")],
        "orsa vega",
    ),
    # The reader's agreement calls it by another name, though its files need not.
    "a group has another id": ([("supervision:\n", "supervising:\n")], "kite"),
    "a group that others read has another id": ([("  sensing:\n", "  seeing:\n")], "kite orsa vega"),
    # And nobody else.
    "a node has another id, and its topics none": (
        [("limiter_node: {", "governor_node: {")],
        "orsa",
    ),
    "something is quicker": ([("lidar: {timing: {rate: 10 Hz, wcet: 5 ms}", "lidar: {timing: {rate: 10 Hz, wcet: 1 ms}")], "vega"),
    "what has a rate is called periodic": ([("ekf: {timing: {rate: 50 Hz", "ekf: {timing: {behaviour: periodic, rate: 50 Hz")], ""),
    "a title": ([("limiter: {", "limiter: {title: Speed limiter, ")], "orsa"),
    "what a component is for": ([("limiter: {", "limiter: {functionality: Keeps it slow near people., ")], "orsa"),
    "a shorter execution time on a host of one's own": ([("driver: {timing: {trigger: [grasp], wcet: 1 ms", "driver: {timing: {trigger: [grasp], wcet: 2 ms")], "palma"),
    "the depth that a reader asks for": ([("reliability: best_effort}}}}\n  limiter", "reliability: best_effort, depth: 3}}}}\n  limiter")], "orsa"),
    "an output that nobody else reads": ([("grasp: Pose}", "grasp: {type: Pose, description: In the gripper's frame}}")], "palma"),
    "a rate that nobody else reads": ([("ui: {timing: {rate: 1 Hz", "ui: {timing: {rate: 2 Hz")], "kite"),
    "an output is added that nobody reads": ([("outputs: {speed: Speed}", "outputs: {speed: Speed, steer: Speed}")], "orsa"),
    "a link that nothing crosses": ([("links: {lan", "links: {can: {connects: [front, arm]}, lan")], ""),
    "a host's title": ([("rear: {cores: 2, scheduling: fixed_priority}", "rear: {title: Rear PC, cores: 2, scheduling: fixed_priority}")], ""),
    "a chain's title": ([("halt: {", "halt: {title: Stop, ")], ""),
    "a group's title": ([("supervision:\n", "supervision:\n    title: Safety\n")], "kite"),
    "a tag": ([("planner: {", "planner: {tags: [slow], ")], "palma"),
    "a component of one's own is renamed": ([("driver", "servo")], "palma"),
    "a node's package": ([("ekf_node: {", "ekf_node: {package: ekf, ")], "orsa"),
    "a parameter of a node": ([("ekf_node: {", "ekf_node: {parameters: {gain: 2}, ")], "orsa"),
    "a requirement that one serves is told better": ([("R-1: Sees rows", "R-1: Sees rows of trees")], "vega"),
    "a view": ([("chains:", "views: {all: {select: sensing}}\nchains:")], ""),
    "a comment": ([("chains:", "# what must be quick\nchains:")], ""),
}  # fmt: skip


@pytest.mark.parametrize("name", try_some(CASES, 12))
def test_whom_a_change_concerns(compared: Compared, name: str) -> None:
    edits, owners = CASES[name]
    after = HARVESTER
    for old, new in edits:
        assert old in after
        after = after.replace(old, new)
    assert " ".join(compared(HARVESTER, after).concerned_owners) == owners
