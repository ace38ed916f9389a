"""Values that cannot be read are errors, and no changes."""

from __future__ import annotations

import pytest

from tests.compare.conftest import Compared, ComparedFolders

ROBOT = """\
groups:
  g:
    components:
      a: {timing: {rate: 10 Hz, wcet: 2 ms, priority: 5, core: 1, every: 2}, outputs: {x: T}}
      b: {inputs: {x: {from: a.x, optional: true}}, timing: {behaviour: event, wcet: 1 ms}}
types: {T: {message: sensor_msgs/msg/Image, size: 1 MB}}
nodes:
  na: {implements: a, host: pc, publishes: {x: {topic: /x, qos: {depth: 1, reliability: best_effort, deadline: 50 ms}}}}
  nb: {implements: b, container: box}
hosts: {pc: {cores: 4}}
containers: {box: {host: pc, threads: 2}}
chains: {see: {through: [a, b], deadline: 300 ms}}
"""


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ("depth: 1", 'depth: "1"'),
        ("cores: 4", 'cores: "4"'),
        ("cores: 4", "cores: four"),
        ("cores: 4", "cores: [4]"),
        ("optional: true", 'optional: "true"'),
        ("optional: true", "optional: yes please"),
        ("threads: 2", 'threads: "2"'),
        ("priority: 5", 'priority: "5"'),
        ("core: 1", "core: '1'"),
        ("every: 2", 'every: "2"'),
        ("rate: 10 Hz", "rate: ten"),
        ("rate: 10 Hz", "period: soon"),
        ("wcet: 2 ms", "wcet: 2 parsecs"),
        ("size: 1 MB", "size: large"),
        ("reliability: best_effort", "reliability: besteffort"),
        ("deadline: 50 ms", "deadline: fifty"),
        ("deadline: 300 ms", "deadline: [300 ms]"),
        ("behaviour: event", "behaviour: eventually"),
    ],
)
def test_what_cannot_be_read_is_no_change(compared: Compared, old: str, new: str) -> None:
    assert old in ROBOT
    comparison = compared(ROBOT, ROBOT.replace(old, new))
    assert [change.text for change in comparison.changes] == []
    assert not comparison.is_judged
    assert [change.text for change in compared(ROBOT.replace(old, new), ROBOT).changes] == []


def test_what_can_be_read_beside_it_is_told(compared: Compared) -> None:
    after = ROBOT.replace("depth: 1, reliability: best_effort", 'depth: "1", reliability: reliable')
    assert [change.text for change in compared(ROBOT, after.replace("cores: 4", "cores: 8")).changes] == [
        "`na.publishes.x`: QoS reliability `best_effort` → `reliable`",
        "host `pc`: cores 4 → 8",
    ]


LIBRARY = {
    "archgen.yaml": """\
archgen: 1
libraries: {common: lib}
groups:
  g:
    components:
      laser: {is: common.laser}
      map: {inputs: {scan: laser.scan}, outputs: {map: Map}}
types: {Map: nav_msgs/msg/OccupancyGrid}
nodes: {map_node: {implements: map}}
""",
    "lib/components.yaml": """\
component_types:
  laser: {outputs: {scan: Scan}, timing: {rate: 10 Hz, wcet: 1 ms}, node: {package: laser_driver, executable: laser}}
""",
    "lib/types.yaml": "types: {Scan: sensor_msgs/msg/LaserScan}\n",
}


@pytest.mark.parametrize(
    "after",
    [
        {**LIBRARY, "lib/components.yaml": LIBRARY["lib/components.yaml"] + "x: [\n"},
        {**LIBRARY, "lib/types.yaml": LIBRARY["lib/types.yaml"] + "x: [\n"},
        {"archgen.yaml": LIBRARY["archgen.yaml"]},
        {"archgen.yaml": LIBRARY["archgen.yaml"].replace("libraries:", "library:")},
    ],
)
def test_of_a_library_that_cannot_be_read_nothing_is_gone(
    compared_folders: ComparedFolders, after: dict[str, str]
) -> None:
    comparison = compared_folders(LIBRARY, after)
    assert [change.text for change in comparison.changes] == []
    assert not comparison.is_judged


SLICES = {
    "archgen.yaml": "archgen: 1\nsources: [a.yaml, an.yaml, b.yaml]\npartners: {a: A, b: B}\nhosts: {pc: {cores: 1}}\n",
    "a.yaml": "groups: {sense: {owner: a, components: {eye: {outputs: {rows: Rows}}}}}\ntypes: {Rows: std_msgs/msg/String}\n",
    "an.yaml": "nodes: {eye: {implements: eye, host: pc, timing: {rate: 10 Hz}}}\nhosts: {pc: {title: Brain}}\n",
    "b.yaml": """\
groups: {drive: {owner: b, components: {base: {inputs: {rows: eye.rows}}}}}
nodes: {base: {implements: base, host: pc, timing: {wcet: 1 ms}}}
chains: {c: {through: [eye, base], deadline: 300 ms}}
""",
}


@pytest.mark.parametrize(
    ("file", "old", "new", "told"),
    [
        ("b.yaml", "", "", []),  # neither where the chain leads, nor what the host is called
        ("a.yaml", "{rows: Rows}", "{rows: {type: Rows, description: In m}}", ["sense.eye.rows"]),
        ("b.yaml", "wcet: 1 ms", "wcet: 2 ms", ["drive.base"]),
        ("b.yaml", "nodes: {", "nodes: {eye2: {implements: eye, host: pc, timing: {rate: 10 Hz}}, ", ["eye2"]),
    ],
)
def test_a_file_that_cannot_be_read_makes_nothing_certain(
    compared_folders: ComparedFolders, file: str, old: str, new: str, told: list[str]
) -> None:
    after = {**SLICES, file: SLICES[file].replace(old, new)}
    after["an.yaml"] += "x\n"
    comparison = compared_folders(SLICES, after)
    assert [change.element_id for change in comparison.changes] == told
    assert [each for change in comparison.changes for each in change.breaks] == []
    assert not comparison.is_judged
