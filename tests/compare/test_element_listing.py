"""Every key of every element in normal form, as plain text beside the files that say it."""

from __future__ import annotations

import tempfile
from pathlib import Path

import pytest

from archgen import pipeline
from archgen.compare.change_listing import list_elements
from archgen.compare.match_elements import match_elements
from archgen.compare.normal_values import ElementTitle, to_plain_data
from archgen.compare.version_pair import ComparedElement, ElementKey
from archgen.products.compared_versions import make_comparison_input

Elements = dict[ElementKey, ComparedElement]


def list_both(before: str, after: str) -> tuple[Elements, Elements]:
    """List the elements of two one-file projects."""
    versions = []
    with tempfile.TemporaryDirectory() as folder:
        for text in (before, after):
            file = Path(folder) / "robot.yaml"
            file.write_text(text, encoding="utf-8")
            versions.append(make_comparison_input(pipeline.check_project(file)))
    matched_ids = match_elements(*(version.architecture for version in versions))
    return list_elements(versions[0], versions[1], matched_ids)


def lines(elements: Elements) -> list[str]:
    """Return `kind id (own id) below parent of owner via components: key=value, ...`, without what is empty."""
    return [_line(each) for each in elements.values()]


def _line(each: ComparedElement) -> str:
    facts = (
        f"{each.kind} {each.id}",
        f"({each.own_id})" if each.own_id != each.id else "",
        f"below {' '.join(each.parent_key)}" if each.parent_key else "",
        f"of {each.owner}" if each.owner else "",
        f"via {' '.join(each.component_refs)}" if each.component_refs else "",
        "" if each.is_declared else "undeclared",
    )
    values = ", ".join(f"{key}={_format(each.values[key])}" for key in sorted(each.values))
    return " ".join(filter(None, facts)) + f": {values}".rstrip()


def _format(value: object) -> str:
    mark = "*" if isinstance(value, ElementTitle) and value.generated else ""
    return f"{to_plain_data(value)}{mark}"


ALL = """\
project: {id: robot, title: Robot, version: "1", description: "D  "}
ros: {distro: jazzy, shared_topics: [/b, /a], definitions: {own_msgs/msg/M: "int8[2] a", own_msgs/srv/S: "int8 a\\n---\\nint8 b"}}
rules: {unread-output: off}
layout: {direction: top-bottom}
report: {chapters: [a.md, groups], texts: {a.md: "One  "}}
review: {main: dev, breaking: error, accepted: {g.a: {reason: Agreed, key: owner}, g.b: Yes}}
partners: {certh: {title: C, description: D, contact: c@d.eu, reviewers: "@c"}, sssa: SSSA}
use_cases: {U: {title: U, description: D}}
requirements: {R: {title: T, description: D, use_cases: [U], tags: [t], urls: {a: "https://a.eu"}}}
groups:
  g:
    title: G
    description: D
    owner: [certh, sssa]
    tags: [t]
    urls: {a: "https://a.eu"}
    layout: {direction: top-bottom}
    components:
      a:
        title: Eye
        functionality: F
        owner: [sssa, certh]
        role: source
        requirements: [R]
        performance: {p: {title: P, accuracy: 90 %, execution_time: 1 ms}}
        timing: {period: 100 ms, jitter: 1 ms, wcet: 2 ms, bcet: 1 ms, priority: 3, core: 0, outputs: {o: {conditional: true, max_gap: 1 s}}}
        urls: {a: "https://a.eu"}
        layout: {direction: left-right}
        inputs: {}
        outputs: {o: {type: T, external: the world}, p: {type: U, medium: physical, description: D}}
      b: {inputs: {i: {from: a.o, type: T, optional: true}}, timing: {trigger: {all: [i]}, response: 3 ms}}
types: {T: {message: own_msgs/msg/M, comment: C, size: 1 kB, status: existing}, S: {request: T, response: T, feedback: T, status: planned}}
nodes:
  n:
    implements: a
    title: N
    owner: sssa
    name: m
    namespace: /ns
    kind: [composable, driver]
    package: p
    executable: e
    plugin: p::P
    container: box
    status: planned
    parameters: {x: {y: true}}
    parameter_files: [p.yaml]
    publishes: {o: {topic: o, qos: {profile: sensor_data, deadline: 5 ms}}}
    internal: {calls: {c: {name: /c, message: own_msgs/srv/S}}}
  k: {implements: b, host: arm}
hosts: {pc: {title: PC, cores: 4, description: D, tags: [t]}, arm: }
containers: {box: {host: pc, threads: 2}}
links: {lan: {connects: [pc, arm], bandwidth: 1 Gbit/s, latency: {best: 1 ms, worst: 2 ms}}}
chains: {c: {through: [a, k], deadline: 1 s, requirements: [R]}}
views: {v: {show: "g  .a", colour: owner, level: implementation, layout: {direction: top-bottom}}, w: {show: g, level: functional}}
policies: {p: {forbid: {from: "g.a  g.b", to: g}}}
"""
# What the first one does not say: component types and their parts, generic types, frames, uses, stored inputs, resources.
FURTHER = """\
partners: {certh: C, sssa: S}
groups:
  g:
    owner: certh
    components:
      a:
        timing: {rate: 10 Hz, wcet: {max: 8 ms, p50: 2 ms, measured: true}, uses: {gpu: {max: 2 ms, min: 1 ms}}, cores: [3]}
        outputs: {o: {type: T, frame: eye}}
        frames: {base: {title: B, parent: map, rate: 10 Hz}, eye: {parent: base, static: true}}
      b:
        inputs: {i: {external: the world}, j: {external: the world}, k: {from: a.o, freshness: 1 s}}
        timing: {trigger: {match: [i, j], within: 1 ms}, every: 2, dropped: forgotten, cores: [1, 2], inputs: {k: {wcet: 1 ms, bcet: 0 ms}, i: {stored: at_once}}, deadline: 9 ms}
      whole: {components: {part: {is: drum, outputs: {o: {external: the world}}}}}
      copy: {same_as: drum, owner: sssa}
component_types:
  drum: {is: box<T>, title: D, functionality: F, description: D, owner: certh, timing: {wcet: 1 ms}, node: {package: p, kind: driver}, tags: [t]}
  box: {generic: [X], abstract: true, inputs: {i: {type: X, external: the world, optional: true}}, outputs: {o: X}, components: {}}
  case: {components: {in: {is: drum, timing: {wcet: 2 ms}}}}
types:
  T: {message: sensor_msgs/msg/Image, status: planned, frame: map}
  F: {fields: {x: {type: float64, default: 0.5, unit: m}, y: {type: "int8[]", default: [1, 2]}, t: "T[2]"}, constants: {A: {type: int8, value: 1}}}
  G: {generic: [P], fields: {p: P, n: int8}, constants: {B: {type: int8, value: 4}}}
  V: {generic: [P], values: [OFF, ON]}
nodes:
  n: {implements: a, owner: sssa, scheduling: ros2_executor, callback_groups: {fast: [a]}, host: pc, parameters: {x: 1}, tags: [t]}
  m: b
  w: {owner: sssa, internal: {publishes: {tf: {topic: /tf, message: tf2_msgs/msg/TFMessage}}}}
frames: {map: {by: w}, odom: {by: a, parent: map}}
hosts: {pc: {cores: 4, scheduling: edf}, arm: {scheduling: {0: fifo}}}
resources: {gpu: {title: G, host: pc, scheduling: fifo}}
"""
# `a` has one node before and two after: both versions say its timing and ports at the nodes.
SPLIT = (
    """\
groups: {g: {components: {a: {outputs: {o: T}}, b: {inputs: {i: a.o}}}}}
nodes:
  n: {implements: a, timing: {rate: 10 Hz}, publishes: {o: {topic: /o}}}
  k: {implements: b, timing: {wcet: 1 ms}}
""",
    """\
groups: {g: {components: {a: {outputs: {o: T}}, b: {inputs: {i: a.o}}}}}
nodes:
  n: {implements: a, timing: {rate: 10 Hz}}
  m: {implements: [a, b], timing: {rate: 5 Hz, wcet: 2 ms}, publishes: {o: {topic: /p}}}
""",
)
# As before, but the only node says little: what it carries then is said for it.
IMPLIED = (
    """\
groups: {g: {components: {a: {inputs: {i: c.q}, outputs: {o: T, p: T}}, b: {outputs: {o: T}}, c: {inputs: {j: a.o}, outputs: {q: T}}}}}
nodes:
  n: {implements: [a, b], publishes: {a.o: {topic: /o}}}
  k: {implements: c}
""",
    """\
groups: {g: {components: {a: {inputs: {i: c.q}, outputs: {o: T, p: T}}, b: {outputs: {o: T}}, c: {inputs: {j: a.o}, outputs: {q: T}}}}}
nodes:
  n: {implements: [a, b], publishes: {a.o: {topic: /o}}}
  m: {implements: a, publishes: {p: {topic: /p}}, subscribes: {i: {}}}
  k: {implements: c}
""",
)
# Everything has another name before.
RENAMED = (
    """\
partners: {sssa: Scuola Superiore}
groups: {one: {owner: sssa, components: {a: {functionality: Sees all, outputs: {o: Image}}, b: {inputs: {i: a.o}}}}}
types: {Image: {message: x_msgs/msg/I}}
nodes: {n: {implements: a, package: p, executable: e, host: pc, publishes: {o: {topic: /o}}}, k: {implements: b, host: pc, package: q, executable: f, subscribes: {i: {qos: {depth: 2}}}}}
hosts: {pc: }
views: {v: {show: one.a+}}
""",
    """\
partners: {santanna: Scuola Superiore}
groups: {two: {owner: santanna, components: {a: {functionality: Sees all, outputs: {o: Picture}}, b: {inputs: {i: a.o}}}}}
types: {Picture: {message: x_msgs/msg/I}}
nodes: {n: {implements: a, package: p, executable: e, host: big, publishes: {o: {topic: /o}}}, k: {implements: b, host: big, package: q, executable: f, subscribes: {i: {qos: {depth: 2}}}}}
hosts: {big: }
views: {v: {show: two.a+}}
""",
)
ROBOTS = {"all": (ALL, ALL), "further": (FURTHER, FURTHER), "split": SPLIT, "renamed": RENAMED}

# The lines before, and those after where they differ.
EXPECTED: dict[str, tuple[list[str], list[str] | None]] = {
    "all": (
        [
            "project robot: chapters=['a.md', 'groups'], description=D, distro=jazzy, id=robot, layout=top-bottom, review.accepted.g.a=Agreed (owner), review.accepted.g.b=Yes, review.breaking=error, review.main=dev, rules.unread-output=off, shared_topics=['/a', '/b'], title=Robot, version=1",
            "chapter a.md: text=One",
            "partner certh of certh: contact=c@d.eu, description=D, reviewers=['@c'], title=C",
            "partner sssa of sssa: title=SSSA",
            "use_case U: description=D, title=U*",
            "requirement R: description=D, tags=['t'], title=T, urls.a=https://a.eu, use_cases=['U']",
            "group g of certh: co_owners=['sssa'], description=D, layout=top-bottom, owner=certh, tags=['t'], title=G*, urls.a=https://a.eu",
            "component g.a below group g of sssa via g.a: co_owners=['certh'], functionality=F, inputs=none, layout=left-right, mapped=True, outputs=some, owner=sssa, performance.p.accuracy=90 %, performance.p.execution_time=1 ms, performance.p.title=P*, requirements=['R'], role=source, timing.bcet=1 ms, timing.core=0, timing.jitter=1 ms, timing.outputs.o.conditional=True, timing.outputs.o.max_gap=1 s, timing.priority=3, timing.rate=10 Hz, timing.wcet=2 ms, title=Eye, urls.a=https://a.eu",
            "component g.b below group g of certh via g.b: co_owners=['sssa'], inputs=some, mapped=True, owner=certh, timing.response=3 ms, timing.trigger=all, timing.trigger.inputs=['g.b.i'], title=B*",
            "output g.a.o below component g.a of sssa via g.a: external=the world, type=T",
            "output g.a.p below component g.a of sssa via g.a: description=D, medium=physical, type=U",
            "input g.b.i below component g.b of certh via g.b: optional=True, type=T",
            "type T: comment=C, message=own_msgs/msg/M, size=1 kB",
            "type S: feedback=T, request=T, response=T, status=planned",
            "type U undeclared:",
            "message own_msgs/msg/M: fields=['int8[2] a']",
            "message own_msgs/srv/S: fields=['int8 a', '---', 'int8 b']",
            "node n of sssa via g.a: container=box, executable=e, implements=['g.a'], kind=['composable', 'driver'], name=m, namespace=/ns, owner=sssa, package=p, parameter_files=['p.yaml'], parameters.x.y=True, plugin=p::P, status=planned, title=N*",
            "node k of certh via g.b: host=arm, implements=['g.b'], owner=certh, title=K*",
            "host pc: cores=4, description=D, tags=['t'], title=PC",
            "host arm: title=Arm*",
            "container box: host=pc, threads=2, title=Box*",
            "link lan: bandwidth=1 Gbit/s, connects=['arm', 'pc'], latency.best=1 ms, latency.worst=2 ms, title=Lan*",
            "chain c: deadline=1 s, requirements=['R'], through=['g.a', 'k'], title=C*",
            "policy p: forbid.from=g.a g.b, forbid.to=g, title=P*",
            "view v: colour=owner, layout=top-bottom, level=implementation, show=g .a, title=V*",
            "view w: show=g, title=W*",
            "port n.publishes.o below node n of sssa via g.a.o: qos.deadline=5 ms, qos.depth=5, qos.reliability=best_effort, topic=['/ns/o']",
            "port n.internal.calls.c below node n of sssa: carried=True, message=own_msgs/srv/S, topic=['/c']",
        ],
        None,
    ),
    "further": (
        [
            "partner certh of certh: title=C",
            "partner sssa of sssa: title=S",
            "component_type drum of certh: description=D, functionality=F, inputs.i=T, inputs.i:external=the world, inputs.i:optional=True, is=box<T>, node.kind=['driver'], node.package=p, outputs.o=T, owner=certh, tags=['t'], timing.wcet=1 ms, title=D",
            "component_type box: abstract=True, generic=['X'], inputs.i=X, inputs.i:external=the world, inputs.i:optional=True, outputs.o=X, title=Box*",
            "component_type case: components=['in'], components.in:description=D, components.in:functionality=F, components.in:inputs.i=T, components.in:inputs.i:external=the world, components.in:inputs.i:optional=True, components.in:is=drum, components.in:node.kind=['driver'], components.in:node.package=p, components.in:outputs.o=T, components.in:tags=['t'], components.in:timing.wcet=2 ms, components.in:title=In*, title=Case*",
            "group g of certh: owner=certh, title=G*",
            "composed g.whole below group g of certh: owner=certh, title=Whole*",
            "component g.a below group g of certh via g.a: mapped=True, outputs=some, owner=certh, timing.core=3, timing.rate=10 Hz, timing.uses.gpu=2 ms, timing.uses.gpu.min=1 ms, timing.wcet=8 ms, timing.wcet.measured=True, timing.wcet.p50=2 ms, title=A*",
            "component g.b below group g of certh via g.b: inputs=some, mapped=True, owner=certh, timing.cores=[1, 2], timing.deadline=9 ms, timing.dropped=forgotten, timing.every=2, timing.inputs.i.stored=at_once, timing.inputs.k.bcet=0 ms, timing.inputs.k.wcet=1 ms, timing.trigger=match, timing.trigger.inputs=['g.b.i', 'g.b.j'], timing.trigger.within=1 ms, title=B*",
            "component g.whole.part below group g of certh via g.whole.part: description=D, functionality=F, inputs=some, is=drum, mapped=True, outputs=some, owner=certh, tags=['t'], timing.wcet=1 ms, title=Part*",
            "component g.copy below group g of sssa via g.copy: description=D, functionality=F, inputs=some, is=exactly drum, mapped=True, outputs=some, owner=sssa, tags=['t'], timing.wcet=1 ms, title=Copy*",
            "output g.a.o below component g.a of certh via g.a: frame=eye, type=T",
            "output g.whole.part.o below component g.whole.part of certh via g.whole.part: external=the world, type=T",
            "output g.copy.o below component g.copy of sssa via g.copy: type=T",
            "input g.b.i below component g.b of certh via g.b: external=the world",
            "input g.b.j below component g.b of certh via g.b: external=the world",
            "input g.b.k below component g.b of certh via g.b: freshness=1 s",
            "input g.whole.part.i below component g.whole.part of certh via g.whole.part: external=the world, optional=True, type=T",
            "input g.copy.i below component g.copy of sssa via g.copy: external=the world, optional=True, type=T",
            "type T: frame=map, message=sensor_msgs/msg/Image, status=planned",
            "type F: fields.t=T[2], message=robot_msgs/msg/F",
            "type G: fields.B=int8 4, fields.n=int8, fields.p=P, generic=['P']",
            "type V: fields.OFF=0, fields.ON=1, generic=['P']",
            "message robot_msgs/msg/F: comments.x=[m], constants.A=int8 1, defaults.x=0.5, defaults.y=[1, 2], fields=['float64 x', 'int8[] y', 'sensor_msgs/msg/Image[2] t']",
            "node n of sssa via g.a: callback_groups.fast=['g.a'], host=pc, implements=['g.a'], owner=sssa, parameters.x=1, scheduling=ros2_executor, tags=['t'], title=N*",
            "node m of certh via g.b: implements=['g.b'], owner=certh, title=M*",
            "node w of sssa: owner=sssa, title=W*",
            "node copy of sssa via g.copy: implements=['g.copy'], kind=['driver'], owner=sssa, package=p, title=Copy*",
            "node part of certh via g.whole.part: implements=['g.whole.part'], kind=['driver'], owner=certh, package=p, title=Part*",
            "host pc: cores=4, scheduling=edf, title=Pc*",
            "host arm: scheduling.0=fifo, title=Arm*",
            "resource gpu: host=pc, scheduling=fifo, title=G",
            "frame map of sssa: by=w, title=map*",
            "frame odom of certh via g.a: by=g.a, parent=map, title=odom*",
            "frame base below component g.a of certh via g.a: by=g.a, parent=map, rate=10 Hz, title=B",
            "frame eye below component g.a of certh via g.a: by=g.a, parent=base, static=True, title=eye*",
            "port w.internal.publishes.tf below node w of sssa: carried=True, message=tf2_msgs/msg/TFMessage, topic=['/tf']",
        ],
        None,
    ),
    "split": (
        [
            "group g: title=G*",
            "component g.a below group g via g.a: mapped=True, outputs=some, title=A*",
            "component g.b below group g via g.b: inputs=some, mapped=True, timing.wcet=1 ms, title=B*",
            "output g.a.o below component g.a via g.a: type=T",
            "input g.b.i below component g.b via g.b:",
            "type T undeclared:",
            "node n via g.a: implements=['g.a'], timing.rate=10 Hz, title=N*",
            "node k via g.b: implements=['g.b'], title=K*",
            "port n.publishes.o below node n via g.a.o: carried=True, topic=['/o']",
        ],
        [
            "group g: title=G*",
            "component g.a below group g via g.a: mapped=True, outputs=some, title=A*",
            "component g.b below group g via g.b: inputs=some, mapped=True, timing.rate=5 Hz, timing.wcet=2 ms, title=B*",
            "output g.a.o below component g.a via g.a: type=T",
            "input g.b.i below component g.b via g.b:",
            "type T undeclared:",
            "node n via g.a: implements=['g.a'], timing.rate=10 Hz, title=N*",
            "node m via g.a g.b: implements=['g.a', 'g.b'], timing.g.a.rate=5 Hz, timing.g.a.wcet=2 ms, title=M*",
            "port m.publishes.a.o below node m via g.a.o: carried=True, topic=['/p']",
        ],
    ),
    "renamed": (
        [
            "partner sssa of sssa: title=Scuola Superiore",
            "group two (one) of sssa: owner=sssa, title=One*",
            "component two.a (one.a) below group two of sssa via two.a: functionality=Sees all, mapped=True, outputs=some, owner=sssa, title=A*",
            "component two.b (one.b) below group two of sssa via two.b: inputs=some, mapped=True, owner=sssa, title=B*",
            "output two.a.o (one.a.o) below component two.a of sssa via two.a: type=Picture",
            "input two.b.i (one.b.i) below component two.b of sssa via two.b:",
            "type Picture (Image) of sssa: message=x_msgs/msg/I",
            "node n of sssa via two.a: executable=e, host=big, implements=['two.a'], owner=sssa, package=p, title=N*",
            "node k of sssa via two.b: executable=f, host=big, implements=['two.b'], owner=sssa, package=q, title=K*",
            "host big (pc): title=Pc*",
            "view v: show=two.a+, title=V*",
            "port n.publishes.o below node n of sssa via two.a.o: topic=['/o']",
            "port k.subscribes.i below node k of sssa via two.b.i: qos.depth=2",
        ],
        [
            "partner santanna of santanna: title=Scuola Superiore",
            "group two of santanna: owner=santanna, title=Two*",
            "component two.a below group two of santanna via two.a: functionality=Sees all, mapped=True, outputs=some, owner=santanna, title=A*",
            "component two.b below group two of santanna via two.b: inputs=some, mapped=True, owner=santanna, title=B*",
            "output two.a.o below component two.a of santanna via two.a: type=Picture",
            "input two.b.i below component two.b of santanna via two.b:",
            "type Picture of santanna: message=x_msgs/msg/I",
            "node n of santanna via two.a: executable=e, host=big, implements=['two.a'], owner=santanna, package=p, title=N*",
            "node k of santanna via two.b: executable=f, host=big, implements=['two.b'], owner=santanna, package=q, title=K*",
            "host big: title=Big*",
            "view v: show=two.a+, title=V*",
            "port n.publishes.o below node n of santanna via two.a.o: topic=['/o']",
            "port k.subscribes.i below node k of santanna via two.b.i: qos.depth=2",
        ],
    ),
}


@pytest.mark.parametrize("name", list(ROBOTS))
def test_all_keys_in_normal_form(name: str) -> None:
    before, after = list_both(*ROBOTS[name])
    expected_before, expected_after = EXPECTED[name]
    assert _parts(before, name) == expected_before
    assert _parts(after, name) == (expected_before if expected_after is None else expected_after)


def _parts(elements: Elements, name: str) -> list[str]:
    return [line for line in lines(elements) if name == "all" or not line.startswith("project")]


def test_what_the_only_node_carries_is_said_for_it_if_the_other_version_has_several() -> None:
    before, after = ([line for line in lines(side) if line.startswith("port")] for side in list_both(*IMPLIED))
    assert before == [
        "port n.publishes.a.o below node n via g.a.o: carried=True, topic=['/o']",
        "port n.publishes.a.p below node n via g.a.p: carried=True",
        "port n.subscribes.a.i below node n via g.a.i: carried=True",
    ]
    assert after == [
        "port n.publishes.a.o below node n via g.a.o: carried=True, topic=['/o']",
        "port m.publishes.p below node m via g.a.p: carried=True, topic=['/p']",
        "port m.subscribes.i below node m via g.a.i: carried=True",
    ]


def test_a_project_that_sets_nothing_has_only_its_chapters() -> None:
    before, _ = list_both(*SPLIT)
    (project,) = (each for key, each in before.items() if key[0] == "project")
    assert list(project.values) == ["chapters"]
