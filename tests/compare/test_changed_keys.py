"""Each key with its values before and after, in normal form, and the sentence that tells it."""

from __future__ import annotations

import pytest

from tests.compare.conftest import Compared, Told

ROBOT = """\
partners: {certh: CERTH, sssa: SSSA}
groups:
  g:
    owner: certh
    components:
      a: {outputs: {x: T}, timing: {rate: 10 Hz, wcet: 2 ms}}
      p: {title: P, parameters: {gain: {value: 1, range: [0, 2]}}, open: [x], operations: {get: T}}
      b: {inputs: {x: a.x}, functionality: Does it., performance: {speed: {accuracy: 90 %}}}
types: {T: {message: sensor_msgs/msg/Image, size: 1 kB}}
hosts: {pc: {cores: 4}, arm: }
containers: {box: {host: pc, threads: 1}}
links: {lan: {connects: [pc, arm], bandwidth: 1 Gbit/s, latency: 1 ms}}
nodes:
  na:
    implements: a
    host: pc
    publishes: {x: {topic: /x, qos: sensor_data}}
    parameters: {deep: {on: true, level: 1}}
chains: {c: {through: [a, b], deadline: 500 ms}}
views: {v: {show: "g.a+"}}
policies: {p: {forbid: {from: g.a, to: "role:sink"}}}
variants: {low: Low, sim: {without: "tag:t g.a", drop: [links.lan], changes: {hosts: {pc: {cores: 2}}}}}
project: {id: robot, title: Robot}
"""


@pytest.mark.parametrize(
    "case",
    [
        ("wcet: 2 ms", "wcet: 3 ms", "component g.a", "timing.wcet", "2 ms", "3 ms", None),
        ("host: pc\n    p", "host: arm\n    p", "node na", "host", "pc", "arm", "node `na` now runs on `arm` instead of `pc`"),
        ("owner: certh", "owner: sssa", "group g", "owner", "certh", "sssa", "group `g` belongs to SSSA now, not to CERTH"),
        ("owner: certh", "owner: [certh, sssa]", "group g", "co_owners", None, ["sssa"], "group `g`: further owners `sssa` added"),
        ("Does it.", "Does that.", "component g.b", "functionality", "Does it.", "Does that.", "`g.b`: functionality `Does it.` → `Does that.`"),
        ("cores: 4", "cores: 2", "host pc", "cores", 4, 2, "host `pc`: cores 4 → 2"),
        ("threads: 1", "threads: 2", "container box", "threads", 1, 2, "container `box`: threads 1 → 2"),
        ("threads: 1", "threads: 1, name: n", "container box", "name", None, "n", None),
        ("threads: 1", "threads: 1, namespace: n", "container box", "namespace", None, "/n", None),
        ("threads: 1", "threads: 1, package: p", "container box", "package", None, "p", None),
        ("threads: 1", "threads: 1, executable: e", "container box", "executable", None, "e", None),
        ("threads: 1", "threads: 1, parameters: {a: {b: 1}}", "container box", "parameters.a.b", None, 1, None),
        ("latency: 1 ms", "latency: {best: 1 ms, worst: 2 ms}", "link lan", "latency.worst", "1 ms", "2 ms", "link `lan`: worst latency `1 ms` → `2 ms`"),
        ("size: 1 kB", "size: 2 kB", "type T", "size", "1 kB", "2 kB", "type `T`: size `1 kB` → `2 kB`; `g.a.x` carries it"),
        ("deadline: 500 ms", "deadline: 0.4 s", "chain c", "deadline", "500 ms", "0.4 s", "chain `c` now must end within `0.4 s` instead of `500 ms`"),
        ('show: "g.a+"', "show: g", "view v", "show", "g.a+", "g", "view `v`: selector `g.a+` → `g`"),
        ('show: "g.a+"', 'show: "g.a+", depth: 2', "view v", "depth", None, 2, "view `v`: depth set to 2"),
        ("from: g.a", "from: g.b", "policy p", "forbid.from", "g.a", "g.b", "policy `p`: forbidden source `g.a` → `g.b`"),
        ('from: g.a, to: "role:sink"}', 'from: g.a, to: "role:sink"}, accepted: {b.x: why}', "policy p", "accepted.g.b.x", None, "why", "policy `p`: accepted input `g.b.x` set to `why`"),
        ("accuracy: 90 %", "accuracy: 80 %", "component g.b", "performance.speed.accuracy", "90 %", "80 %", "`g.b`: performance speed accuracy `90 %` → `80 %`"),
        ("without: ", "of: [low], without: ", "variant sim", "of", None, ["low"], "variant `sim` is now built on `low`"),
        ("tag:t g.a", "tag:u", "variant sim", "without", "tag:t g.a", "tag:u", "variant `sim` now is without `tag:u` instead of `tag:t g.a`"),
        ("[links.lan]", "[links.lan.title]", "variant sim", "drop", ["links.lan"], ["links.lan.title"], None),
        ("pc: {cores: 2}", "pc: {cores: 3}", "variant sim", "changes", ["hosts.pc.cores: 2"], ["hosts.pc.cores: 3"], None),
        ("topic: /x", "topic: /y", "port na.publishes.x", "topic", ["/x"], ["/y"], "`na.publishes.x`: topic `/x` → `/y`"),
        ("on: true", "on: false", "node na", "parameters.deep.on", True, False, "node `na`: parameter `deep.on` true → false"),
        ("level: 1", 'level: "1"', "node na", "parameters.deep.level", 1, "1", None),
        ("level: 1", "level: true", "node na", "parameters.deep.level", 1, True, None),
        ("pc: {cores: 4}, arm: }", "pc: {cores: 4}, arm: }\nros: {parameters: {use_sim_time: true}}", "project robot", "parameters.use_sim_time", None, True, "the project: parameter `use_sim_time` set to true"),
        ("gain: {value: 1", "gain: {value: 2", "component g.p", "parameters.gain", 1, 2, "`g.p`: parameter `gain` 1 → 2"),
        ("gain: {value: 1", "gain: {value: [1, 2]", "component g.p", "parameters.gain", 1, "[1, 2]", "`g.p`: parameter `gain` 1 → `[1, 2]`"),
        ("range: [0, 2]", "range: [0, 3]", "component g.p", "parameters.gain:range", "0 to 2", "0 to 3", "`g.p`: range of the parameter `gain` `0 to 2` → `0 to 3`"),
        ("range: [0, 2]", "range: [0, 2], read_only: true", "component g.p", "parameters.gain:read_only", None, True, "`g.p`: read only of the parameter `gain` set to true"),
        ("get: T", "get: {response: T, call: synchronous}", "component g.p", "operations.get:call", None, "synchronous", "`g.p`: call of the operation `get` set to `synchronous`"),
        ("open: [x]", "open: [x, y]", "component g.p", "open", ["x"], ["x", "y"], "`g.p`: open sets `y` added"),
        ("{deep: {on: true, level: 1}}", "{deep: {on: true, level: 1}}\n    parameter_commands: {d: [cat, x]}", "node na", "parameter_commands.d", None, "cat x", "node `na`: command for the parameter `d` set to `cat x`"),
        ("open: [x]", "open: [x], properties: {trl: 5}", "component g.p", "properties.trl", None, "5", "`g.p`: property `trl` set to `5`"),
        ("open: [x]", "open: [x], hints: {orca: {tag: [a, b]}}", "component g.p", "hints.orca.tag", None, "[a, b]", "`g.p`: hint `orca.tag` set to `[a, b]`"),
        ("open: [x]", "open: [x], status: adapted", "component g.p", "status", None, "adapted", None),
        ("open: [x]", "open: [x], contact: x@y.eu", "component g.p", "contact", None, "x@y.eu", "`g.p`: contact set to `x@y.eu`"),
        ("open: [x]", "open: [x], image: x.png", "component g.p", "image", None, "x.png", "`g.p`: picture set to `x.png`"),
        ("cores: 4", "cores: 4, properties: {ram: 8 GB}", "host pc", "properties.ram", None, "8 GB", "host `pc`: property `ram` set to `8 GB`"),
        ("partners: {certh: CERTH", "properties: {trl: {}}\npartners: {certh: CERTH", "project robot", "properties.trl", None, "declared", "the project: property `trl` set to `declared`"),
        ("partners: {certh: CERTH", "glossary: {MCI: x}\npartners: {certh: CERTH", "project robot", "glossary.MCI", None, "x", "the project: term `MCI` set to `x`"),
        ("title: Robot", "title: Car", "project robot", "title", "Robot", "Car", "the project: title `Robot` → `Car`"),
        ("inputs: {x: a.x}", "inputs: {x: {from: a.x, optional: true}}", "input g.b.x", "optional", None, True, "`g.b.x` is optional now"),
        ("partners: {certh: CERTH", "rules: {unread-output: off}\npartners: {certh: CERTH", "project robot", "rules.unread-output", None, "off", "the project: severity of the rule `unread-output` set to `off`"),
        ("partners: {certh: CERTH", "rules: {late-chain: {margin: 20 %}}\npartners: {certh: CERTH", "project robot", "rules.late-chain.margin", None, "20 %", "the project: `margin` of the rule `late-chain` set to `20 %`"),
        ("partners: {certh: CERTH", "rules: {late-chain: {severity: error}}\npartners: {certh: CERTH", "project robot", "rules.late-chain", None, "error", "the project: severity of the rule `late-chain` set to `error`"),
    ],
)  # fmt: skip
def test_keys(compared: Compared, case: tuple[str, str, str, str, object, object, str | None]) -> None:
    old, new, element, key, before, after, text = case
    assert old in ROBOT
    (change,) = compared(ROBOT, ROBOT.replace(old, new, 1)).changes
    assert (change.kind, f"{change.element_kind} {change.element_id}", change.key) == ("changed", element, key)
    assert (change.before, change.after) == (before, after)
    assert text is None or change.text == text
    (back,) = compared(ROBOT.replace(old, new, 1), ROBOT).changes
    assert (back.before, back.after) == (after, before)


EXECUTORS = """\
groups:
  g:
    components:
      a: {outputs: {x: std_msgs/msg/Bool, y: std_msgs/msg/Bool}}
      b: {inputs: {x: {from: a.x, freshness: 1 s}, y: a.y, z: a.x}}
      c: {inputs: {x: a.x}}
nodes:
  na: {implements: a, host: pc, timing: {rate: 10 Hz, wcet: {max: 4 ms, p50: 1 ms, measured: true}, cores: [1, 2], uses: {gpu: {max: 6 ms, min: 2 ms}}, deadline: 9 ms}}
  nb: {implements: b, host: pc, reentrant: true, timing: {trigger: {match: [x, y], within: 3 ms}, every: 2, dropped: forgotten, inputs: {z: {wcet: 2 ms}}}}
  nc: {implements: [c], host: pc, threads: 3, scheduling: fifo}
  nd: {implements: [c], host: pc, callback_groups: {q: [c]}}
hosts: {pc: {cores: 4, scheduling: {0: edf}}, arm: {cores: 2, scheduling: fifo}}
containers: {box: {scheduling: edf}}
resources: {gpu: {host: pc, scheduling: fifo}}
"""


@pytest.mark.parametrize(
    "case",
    [
        ("max: 4 ms", "max: 5 ms", "component g.a", "timing.wcet", "4 ms", "5 ms", "`g.a`: worst case execution time `4 ms` → `5 ms`"),
        ("p50: 1 ms", "p50: 2 ms", "component g.a", "timing.wcet.p50", "1 ms", "2 ms", "`g.a`: wcet p50 `1 ms` → `2 ms`"),
        (", measured: true", "", "component g.a", "timing.wcet.measured", True, None, "`g.a`: wcet measured no longer given (it was true)"),
        ("[1, 2]", "[1, 3]", "component g.a", "timing.cores", [1, 2], [1, 3], "`g.a`: cores 3 added, 2 removed"),
        ("max: 6 ms", "max: 7 ms", "component g.a", "timing.uses.gpu", "6 ms", "7 ms", "`g.a`: use of `gpu` `6 ms` → `7 ms`"),
        ("min: 2 ms", "min: 1 ms", "component g.a", "timing.uses.gpu.min", "2 ms", "1 ms", "`g.a`: use of `gpu.min` `2 ms` → `1 ms`"),
        ("deadline: 9 ms", "deadline: 8 ms", "component g.a", "timing.deadline", "9 ms", "8 ms", "`g.a`: deadline `9 ms` → `8 ms`"),
        ("freshness: 1 s", "freshness: 0.5 s", "input g.b.x", "freshness", "1 s", "0.5 s", "`g.b.x` now must be no older than `0.5 s` instead of `1 s`"),
        ("reentrant: true, ", "", "node nb", "reentrant", True, None, "node `nb`: reentrant no longer given (it was true)"),
        ("within: 3 ms", "within: 0 ms", "component g.b", "timing.trigger.within", "3 ms", "0 ms", "`g.b`: trigger within `3 ms` → `0 ms`"),
        ("dropped: forgotten", "dropped: kept", "component g.b", "timing.dropped", "forgotten", None, "`g.b`: what becomes of dropped messages no longer given (it was `forgotten`)"),
        ("z: {wcet: 2 ms}", "z: {wcet: 1 ms}", "component g.b", "timing.inputs.z.wcet", "2 ms", "1 ms", None),
        ("threads: 3", "threads: 2", "node nc", "threads", 3, 2, "node `nc`: threads 3 → 2"),
        ("threads: 3", "threads: 1", "node nc", "threads", 3, None, None),
        ("scheduling: fifo}\n  nd", "scheduling: edf}\n  nd", "node nc", "scheduling", "fifo", "edf", "node `nc`: scheduling `fifo` → `edf`"),
        (", callback_groups: {q: [c]}", "", "node nd", "callback_groups.q", ["g.c"], None, "node `nd`: callback group `q` `g.c` removed"),
        ("0: edf", "0: fifo", "host pc", "scheduling.0", "edf", "fifo", "host `pc`: order on core `0` `edf` → `fifo`"),
        ("cores: 2, scheduling: fifo", "cores: 2, scheduling: edf", "host arm", "scheduling", "fifo", "edf", "host `arm`: scheduling `fifo` → `edf`"),
        ("{scheduling: edf}", "{}", "container box", "scheduling", "edf", None, None),
        ("gpu: {host: pc", "gpu: {host: arm", "resource gpu", "host", "pc", "arm", "resource `gpu` now runs on `arm` instead of `pc`"),
        ("host: pc, scheduling: fifo}}", "host: pc}}", "resource gpu", "scheduling", "fifo", None, None),
    ],
)  # fmt: skip
def test_keys_of_executors_and_resources(
    compared: Compared, case: tuple[str, str, str, str, object, object, str | None]
) -> None:
    old, new, element, key, before, after, text = case
    assert old in EXECUTORS
    (change,) = compared(EXECUTORS, EXECUTORS.replace(old, new, 1)).changes
    assert (f"{change.element_kind} {change.element_id}", change.key) == (element, key)
    assert (change.before, change.after) == (before, after)
    assert text is None or change.text == text


def test_one_core_is_the_same_in_a_set_and_alone(told: Told) -> None:
    assert told(EXECUTORS.replace("cores: [1, 2]", "cores: [3]"), EXECUTORS.replace("cores: [1, 2]", "core: 3")) == []
    assert told(EXECUTORS, EXECUTORS.replace("cores: [1, 2]", "cores: [2, 1, 2]")) == []
    assert told(EXECUTORS, EXECUTORS.replace("max: 4 ms", "max: 0.004 s")) == []


def test_a_resource_with_another_id_is_recognised_by_its_users(told: Told) -> None:
    assert told(EXECUTORS, EXECUTORS.replace("gpu", "graphics")) == [
        "renamed resource graphics: resource `gpu` is called `graphics` now"
    ]


def test_the_message_of_a_type_names_who_carries_it(told: Told) -> None:
    assert told(ROBOT, ROBOT.replace("sensor_msgs/msg/Image", "sensor_msgs/msg/CompressedImage")) == [
        "changed type T: type `T` now is `sensor_msgs/msg/CompressedImage` instead of `sensor_msgs/msg/Image`; `g.a.x` carries it"
    ]


def test_all_that_changed_of_qos_is_one_change(compared: Compared) -> None:
    other = "qos: {reliability: reliable, depth: 2}"
    (change,) = compared(ROBOT, ROBOT.replace("qos: sensor_data", other)).changes
    assert (change.element_kind, change.element_id, change.key) == ("port", "na.publishes.x", "qos")
    assert change.before == {"depth": 5, "reliability": "best_effort"}
    assert change.after == {"depth": 2, "reliability": "reliable"}
    assert change.text == "`na.publishes.x`: QoS depth 5 → 2 and reliability `best_effort` → `reliable`"


def test_a_type_at_a_port_names_the_readers(told: Told) -> None:
    assert told(ROBOT, ROBOT.replace("outputs: {x: T}", "outputs: {x: U}")) == [
        "changed output g.a.x: `g.a.x` now carries `U` instead of `T`; it is read by `g.b.x`"
    ]


def test_the_fields_of_a_message_concern_who_carries_it(compared: Compared) -> None:
    text = ROBOT.replace("sensor_msgs/msg/Image", "own_msgs/msg/Image")
    text += (
        'ros: {definitions: {own_msgs/msg/Image: "int32 a\\nint32 b", own_msgs/srv/Do: "int32 x\\n---\\nint32 y"}}\n'
    )
    found = compared(text, text.replace("int32 b", "int64 b"))
    (change,) = found.changes
    assert (change.element_kind, change.element_id, change.key) == ("message", "own_msgs/msg/Image", "fields")
    assert (change.before, change.after) == (["int32 a", "int32 b"], ["int32 a", "int64 b"])
    assert change.text == "message `own_msgs/msg/Image`: `b` is `int64` instead of `int32`; it carries `T`"
    assert found.concerned_owners == ("certh",)
    (change,) = compared(text, text.replace("int32 x\\n---", "---\\nint32 x")).changes
    assert (change.before, change.after) == (["int32 x", "---", "int32 y"], ["---", "int32 x", "int32 y"])


def test_a_long_or_hostile_text_stays_on_one_line(told: Told) -> None:
    title = "Evil `rm`\\n| <b>" + "x" * 200
    (line,) = told(ROBOT, ROBOT.replace("title: Robot", f'title: "{title}"'))
    assert line == f"changed project robot: the project: title `Robot` → `Evil 'rm' | <b>{'x' * 64}…`"


def test_a_chapter_that_was_written_anew(told: Told) -> None:
    text = ROBOT + "report: {chapters: [a.md, groups], texts: {a.md: One}}\n"
    assert told(text, text.replace("One", "Two")) == ["changed chapter a.md: the text of chapter `a.md` is rewritten"]
    assert told(text, text.replace("[a.md, groups]", "[groups, a.md]")) == [
        "changed project robot: the project: chapters are now `groups` and `a.md`, in this order"
    ]


def test_an_option_that_is_written_in_another_way_has_not_changed(told: Told) -> None:
    assert told("rules: {late-chain: {margin: 20 %}}\n", "rules: {late-chain: {margin: 20.0%}}\n") == []
    assert told("rules: {late-chain: {margin: 20 %}}\n", "rules: {late-chain: {margin: 2.5 %}}\n") == [
        "changed project robot: the project: `margin` of the rule `late-chain` `20 %` → `2.5 %`"
    ]


START = """\
groups: {g: {components: {a: {outputs: {x: std_msgs/msg/Bool}}, b: {inputs: {x: a.x}}}}}
nodes:
  na: {implements: a, kind: lifecycle, command: [run, it], start: {phase: core, by: m, ready: {topic: up, within: 2 s}, environment: {A: b}}}
  nb: {implements: b, start: {after: na, user: robot}}
  m: {kind: program, command: [m]}
"""


@pytest.mark.parametrize(
    "case",
    [
        ("phase: core", "phase: network", "na", "start.phase", "core", "network", "start phase `core` → `network`, so earlier than before"),
        ("phase: core, ", "", "na", "start.phase", "core", None, "start phase no longer given (it was `core`), so later than before"),
        ("user: robot", "user: robot, phase: components", "nb", "start.phase", None, "components", "start phase set to `components`, as before"),
        ("after: na", "after: [na, m]", "nb", "start.after", ["na"], ["m", "na"], " now starts after `m`"),
        ("topic: up", "topic: /up", "na", "start.ready.topic", None, None, None),
        ("topic: up", "topic: ~/up", "na", "start.ready.topic", "/up", "/na/up", "topic that shows it is up `/up` → `/na/up`"),
        ("within: 2 s", "within: 3 s", "na", "start.ready.within", "2 s", "3 s", "longest time until it is up `2 s` → `3 s`"),
        ("A: b", "A: c", "na", "start.environment.A", "b", "c", "environment variable `A` `b` → `c`"),
        (", user: robot", "", "nb", "start.user", "robot", None, "user as whom it runs no longer given (it was `robot`)"),
        ("by: m", "state: inactive, by: m", "na", "start.state", None, "inactive", "state that it is brought into set to `inactive`"),
        ("[run, it]", '[run, "it all"]', "na", "command", "run it", "run 'it all'", None),
    ],
)  # fmt: skip
def test_keys_of_the_start_up(compared: Compared, case: tuple[str, str, str, str, object, object, str | None]) -> None:
    old, new, element, key, before, after, text = case
    assert old in START
    changes = compared(START, START.replace(old, new, 1)).changes
    if before is after is None:
        assert changes == ()
        return
    (change,) = changes
    assert (f"{change.element_kind} {change.element_id}", change.key) == (f"node {element}", key)
    assert (change.before, change.after) == (before, after)
    if text is not None:
        assert change.text == (f"node `{element}`{text}" if text.startswith(" ") else f"node `{element}`: {text}")


TREE = """\
use_cases: {UC-1: Walks}
requirements:
  R-1: {title: Safe, priority: must, verified_by: [UC-1, a.py]}
  R-2: Quiet
  R-3: {title: Slow, parent: R-1, kind: safety, rationale: Because, source: D1}
"""


@pytest.mark.parametrize(
    ("old", "new", "text"),
    [
        ("parent: R-1", "parent: R-2", "requirement `R-3`: parent `R-1` → `R-2`"),
        ("parent: R-1", "parent: [R-2, R-1]", "requirement `R-3` is now part of `R-2`"),
        ("must", "should", "requirement `R-1`: priority `must` → `should`"),
        (", kind: safety", "", "requirement `R-3`: kind no longer given (it was `safety`)"),
        ("Because", "Since", "requirement `R-3`: rationale `Because` → `Since`"),
        ("[UC-1, a.py]", "UC-1", "requirement `R-1` is no longer verified by `a.py`"),
        ("[UC-1, a.py]", "[a.py, UC-1]", None),
    ],
)
def test_keys_of_requirements(compared: Compared, old: str, new: str, text: str | None) -> None:
    assert old in TREE
    changes = compared(TREE, TREE.replace(old, new, 1)).changes
    assert [change.text for change in changes] == ([text] if text else [])
