"""The packed project: one file that is itself a project, finds the same, and packs to the same bytes."""

from __future__ import annotations

import base64
import json
from dataclasses import asdict
from pathlib import Path

import jsonschema_rs
import pytest
import yaml
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from archgen.analyses.size_counts import measure_progress, measure_size
from archgen.checking.checked_packing import pack_checked_project
from archgen.frozen import replace
from archgen.language.language_tables import SECTION_KINDS
from archgen.pipeline import CheckedProject, check_project
from archgen.schema.language_schema import load_schema
from archgen.syntax.yaml_writer import write_yaml
from tests.judged_projects import judge_shipped
from tests.language_samples import SCHEMA, list_samples
from tests.property_sizes import try_some

ROOT = Path(__file__).resolve().parents[2]


def project(folder: Path, **files: str | bytes) -> CheckedProject:
    """Write files (`a__b_yaml` is a/b.yaml) and check the project."""
    for name, data in files.items():
        stem, _, ending = name.replace("__", "/").rpartition("_")
        path = folder / f"{stem}.{ending}"
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(data if isinstance(data, bytes) else data.encode())
    return check_project(folder)


def text_of(checked: CheckedProject) -> str:
    """Pack a project."""
    packed = pack_checked_project(checked)
    return write_yaml(packed.data, packed.comments)


def said(checked: CheckedProject) -> list[tuple[str, str, str, str]]:
    """Give the findings without their places; a packed project says itself what the type mapper said before."""
    findings = (d for d in checked.findings if d.rule != "borrowed-message")
    return sorted((str(d.severity), d.rule, d.message, d.help or "") for d in findings)


def packed_again(checked: CheckedProject, folder: Path) -> CheckedProject:
    """Pack a project, check what holds of every packed file, and give it as a project."""
    text = text_of(checked)
    file = folder / "packed.yaml"
    file.write_text(text, encoding="utf-8")
    again = check_project(file)
    assert text_of(again) == text
    assert said(again) == said(checked)
    assert asdict(measure_size(again.architecture)) == asdict(measure_size(checked.architecture))
    assert measure_progress(again.architecture) == measure_progress(checked.architecture)
    assert again.architecture.edges == checked.architecture.edges
    assert again.architecture.topics == checked.architecture.topics
    assert again.architecture.nodes == checked.architecture.nodes
    assert again.architecture.components == checked.architecture.components
    data = yaml.safe_load(text)
    assert list(jsonschema_rs.Draft202012Validator(load_schema()).iter_errors(data)) == []
    assert "sources" not in data
    return again


@pytest.mark.parametrize(
    "example",
    try_some(
        [
            "examples/first_robot",
            "examples/cleaning_robot",
            "examples/arm",
            "examples/vehicle/two_lasers",
            "examples/bringup",
            "example_ramcip",
        ],
        4,
    ),
)
def test_the_examples(example: str, tmp_path: Path) -> None:
    packed_again(judge_shipped(ROOT / example), tmp_path)


def test_slices_and_short_forms_become_one_mapping(tmp_path: Path) -> None:
    checked = project(
        tmp_path / "robot",
        archgen_yaml="archgen: 1\nproject: {id: r, title: R, version: 1.10}\nsources: ['*.yaml']\n",
        b_yaml="groups: {g: {components: {c: {timing: {rate: 10 Hz}, inputs: {x: d, y: , z: [d.o, d.p]}}}}}\n",
        c_yaml="groups: {g: {title: No, components: {c: C, d: {outputs: {o: Colour image, p: Flag}, inputs: {}}}}}\n",
        d_yaml="nodes: {n: {implements: [c], parameters: {a: 1.10, b: no, c: [1, {x: ~}]}, tags: []}}\n",
    )
    assert text_of(checked) == (
        """\
archgen: 1
project:
  id: r
  title: R
  version: "1.10"
groups:
  g:
    components:
      c:
        timing:
          rate: 10 Hz
        inputs:
          x:
            from:
              - d
          "y": {}
          z:
            from:
              - d.o
              - d.p
        title: C
      d:
        outputs:
          o:
            type: Colour image
          p:
            type: Flag
        inputs: {}
    title: "No"
nodes:
  "n":
    implements:
      - c
    parameters:
      a: 1.1
      b: "no"
      c:
        - 1
        -
          x: null
    tags: []
types:
  Colour image:
    message: sensor_msgs/msg/Image
    comment: "640 x 480, three bytes a pixel"
    size: 922 kB
  Flag:
    message: std_msgs/msg/Bool
    size: 5 B
"""
    )
    packed_again(checked, tmp_path)


def test_ignore_comments_stay_at_their_elements(tmp_path: Path) -> None:
    checked = project(
        tmp_path / "robot",
        archgen_yaml="archgen: 1\n",
        a_yaml="""\
groups:
  g:
    components:
      c:
        inputs: {x: {external: World, medium: physical}}
        outputs:
          o: Flag  # archgen: ignore[unread-output] for later
          p: Flagg # archgen: ignore[unread-output, unmapped-type]
      d: {inputs: {x: {external: World, medium: physical}}, outputs: {q: Flag}} # archgen: ignore[unread-output] all in one line
""",
        b_yaml='nodes:\n  n: c\n  m: d\n  idle: {title: I} # archgen: ignore[unjustified-node] it is a "tool"\n',
    )
    assert [d.rule for d in checked.findings if d.severity != "note"] == []
    text = text_of(checked)
    assert "          o:  # archgen: ignore[unread-output] for later\n" in text
    assert (
        "          p:  # archgen: ignore[unread-output]\n            type: Flagg  # archgen: ignore[unmapped-type]\n"
        in text
    )
    assert '  idle:  # archgen: ignore[unjustified-node] it is a "tool"\n' in text
    packed_again(checked, tmp_path)


PIXEL = base64.b64decode(
    "iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAYAAAAfFcSJAAAADUlEQVR42mNk+M9QDwADhgGAWjR9awAAAABJRU5ErkJggg=="
)


def test_of_the_types_that_no_file_declares_the_shipped_ones_come_along(tmp_path: Path) -> None:
    ports = "{a: Colour image, b: Unheard of, c: std_msgs/msg/Bool, d: Own}"
    checked = project(
        tmp_path / "robot",
        archgen_yaml=f"archgen: 1\ngroups: {{g: {{components: {{c: {{outputs: {ports}}}}}}}}}\ntypes: {{Own: std_msgs/msg/Bool}}\n",
    )
    assert list(yaml.safe_load(text_of(checked))["types"]) == ["Own", "Colour image"]


def test_chapters_pictures_and_definitions_come_along(tmp_path: Path) -> None:
    checked = project(
        tmp_path / "robot",
        archgen_yaml="""\
archgen: 1
ros: {distro: jazzy, interfaces: ["msgs/**/*.msg"], shared_topics: [/estop]}
report: {chapters: [docs/intro.md, groups]}
groups: {g: {components: {c: {outputs: {o: {type: my_msgs/msg/Grasp, external: Out}}}}}}
nodes: {n: c}
""",
        docs__intro_md="# Über\r\n\r\n    code\r\n\r\n![a](img/pixel.png)\r\nEnd:  \r\n\ttab",
        docs__img__pixel_png=PIXEL,
        msgs__my_msgs__msg__Grasp_msg="# a grasp\nfloat32 width\n\n",
    )
    again = packed_again(checked, tmp_path)
    data = yaml.safe_load(text_of(again))
    assert data["ros"] == {
        "distro": "jazzy",
        "shared_topics": ["/estop"],
        "definitions": {"my_msgs/msg/Grasp": "# a grasp\nfloat32 width\n\n"},
    }
    assert again.chapters.texts["docs/intro.md"].text == checked.chapters.texts["docs/intro.md"].text.replace(
        "\r\n", "\n"
    )
    assert again.chapters.read_picture("docs/img/pixel.png") == PIXEL
    assert again.chapters.order == ("docs/intro.md", "groups")
    assert again.architecture.interfaces.status_of("my_msgs/msg/Grasp") == "known"


def test_a_broken_project_packs_what_is_sound(tmp_path: Path) -> None:
    checked = project(
        tmp_path / "robot",
        archgen_yaml="archgen: 1\ngroups: {g: {titel: G, components: {c: {role: fliter, inputs: {i: nope}}}}}\n",
        b_yaml="groups: {",
    )
    text = text_of(checked)
    assert yaml.safe_load(text)["groups"] == {"g": {"components": {"c": {"inputs": {"i": {"from": ["nope"]}}}}}}
    (tmp_path / "packed.yaml").write_text(text, encoding="utf-8")
    assert text_of(check_project(tmp_path / "packed.yaml")) == text


def test_what_one_file_declares_by_its_id_and_another_tags_stays_declared(tmp_path: Path) -> None:
    checked = project(
        tmp_path / "robot",
        archgen_yaml="archgen: 1\nsources: [a.yaml, b.yaml]\n",
        a_yaml="groups: {g: {components: {c: {}}}, h: {}}\n",
        b_yaml="groups: {g: {components: {c: {tags: [x]}}}, h: {owner: p}}\npartners: {p: P}\n",
    )
    packed_again(checked, tmp_path)
    assert yaml.safe_load(text_of(checked))["groups"] == {
        "g": {"components": {"c": {"title": "C", "tags": ["x"]}}},
        "h": {"title": "H", "owner": "p"},
    }


def test_an_element_whose_declaration_is_damaged_stays_declared(tmp_path: Path) -> None:
    checked = project(
        tmp_path / "robot",
        archgen_yaml='archgen: 1\ngroups: {g: {components: {c: {tags: ["", "0"]}}}}\n',
    )
    text = text_of(checked)
    assert yaml.safe_load(text)["groups"] == {"g": {"components": {"c": {"title": "C", "tags": ["0"]}}}}
    (tmp_path / "packed.yaml").write_text(text, encoding="utf-8")
    assert text_of(check_project(tmp_path / "packed.yaml")) == text


IDS = st.sampled_from(["a", "b2", "on_off", "y", "null_one", "e5"])
WORDS = st.text(
    st.characters(codec="utf-8", exclude_categories=["Cs", "Cc"])
    | st.sampled_from("\n:#-'\"\\ {}[]&*!|>%@`,?~0123456789"),
    max_size=20,
)
DATA = st.recursive(
    st.one_of(st.none(), st.booleans(), st.integers(), st.floats(allow_nan=False), WORDS),
    lambda inner: st.lists(inner, max_size=3) | st.dictionaries(WORDS.filter(bool), inner, max_size=3),
    max_leaves=6,
)
PROMISES = st.fixed_dictionaries(
    {},
    optional={
        "rate": st.sampled_from(["10 Hz", "0.5 kHz", "0 Hz"]),
        "unit": WORDS,
        "frame": IDS,
        "range": st.lists(st.sampled_from([0, 1.5, -2, "3 m", ".inf", "1e3"]), max_size=3),
    },
)
DEPRECATIONS = st.fixed_dictionaries({}, optional={"until": st.sampled_from(["2999-01-01", "2999-02-30"]), "use": IDS})
SAID = {"promise": PROMISES, "version": WORDS, "deprecated": DEPRECATIONS}
OUTPUTS = st.dictionaries(
    IDS, st.one_of(WORDS, st.fixed_dictionaries({}, optional={"type": WORDS, "external": WORDS, **SAID}))
)
INPUTS = st.dictionaries(
    IDS, st.one_of(IDS, st.lists(IDS), st.fixed_dictionaries({}, optional={"from": IDS, "description": WORDS}))
)
COMPONENT = st.one_of(
    WORDS,
    st.none(),
    st.fixed_dictionaries(
        {},
        optional={
            "title": WORDS,
            "functionality": WORDS,
            "role": st.sampled_from(["source", "sink"]),
            "inputs": INPUTS,
            "outputs": OUTPUTS,
            "tags": st.lists(WORDS, max_size=2),
            "properties": st.dictionaries(IDS, st.one_of(st.none(), st.booleans(), st.integers(), st.floats(), WORDS)),
            "hints": st.dictionaries(IDS, DATA),
            "status": st.sampled_from(["planned", "existing"]),
            "requirements": st.lists(WORDS, max_size=2),
        },
    ),
)
START = st.fixed_dictionaries(
    {},
    optional={
        "phase": st.sampled_from(["core", "cores"]),
        "after": st.one_of(IDS, st.lists(IDS, max_size=2)),
        "ready": st.one_of(
            st.just("2 s"), st.fixed_dictionaries({}, optional={"port": st.integers(0, 90000), "log": WORDS})
        ),
        "respawn": st.booleans(),
        "environment": st.dictionaries(st.sampled_from(["port", "once", "A"]), st.one_of(WORDS, st.integers())),
        "by": IDS,
    },
)
STEP = st.fixed_dictionaries({"from": IDS, "to": IDS}, optional={"say": WORDS})
USE_CASE = st.one_of(
    WORDS,
    st.none(),
    st.fixed_dictionaries(
        {},
        optional={
            "title": WORDS,
            "actors": st.dictionaries(IDS, st.one_of(WORDS, st.none()), max_size=2),
            "steps": st.lists(STEP, max_size=3),
        },
    ),
)
PROJECTS = st.fixed_dictionaries(
    {"archgen": st.just(1)},
    optional={
        "project": st.fixed_dictionaries({}, optional={"title": WORDS, "description": WORDS}),
        "groups": st.dictionaries(IDS, st.fixed_dictionaries({"components": st.dictionaries(IDS, COMPONENT)})),
        "nodes": st.dictionaries(
            IDS,
            st.fixed_dictionaries(
                {},
                optional={
                    "implements": IDS,
                    "parameters": st.dictionaries(IDS, DATA),
                    "command": st.one_of(st.just("stage"), st.lists(WORDS, max_size=2)),
                    "start": st.one_of(IDS, st.lists(IDS, max_size=2), START),
                },
            ),
        ),
        "frames": st.dictionaries(
            IDS, st.one_of(st.none(), IDS, st.fixed_dictionaries({"by": IDS, "static": st.booleans()}))
        ),
        "variants": st.dictionaries(
            st.sampled_from(["sim", "indoor", "base"]),
            st.one_of(
                st.none(),
                WORDS,
                st.fixed_dictionaries(
                    {},
                    optional={
                        "of": st.sampled_from(["sim", "indoor", ["indoor"], "x"]),
                        "without": st.sampled_from(["a", "tag:t", "*.a", "", "-a"]),
                        "drop": st.sampled_from(["nodes.a", ["nodes", "x.y"], "links.a.b"]),
                        "changes": st.fixed_dictionaries(
                            {},
                            optional={
                                "groups": st.dictionaries(
                                    IDS, st.fixed_dictionaries({"components": st.dictionaries(IDS, COMPONENT)})
                                ),
                                "nodes": st.dictionaries(
                                    IDS,
                                    st.fixed_dictionaries(
                                        {}, optional={"implements": IDS, "parameters": st.dictionaries(IDS, DATA)}
                                    ),
                                ),
                            },
                        ),
                    },
                ),
            ),
            max_size=2,
        ),
        "properties": st.dictionaries(
            IDS, st.one_of(WORDS, st.fixed_dictionaries({}, optional={"range": st.lists(st.integers(), max_size=3)}))
        ),
        "use_cases": st.dictionaries(IDS, USE_CASE, max_size=2),
        "glossary": st.dictionaries(WORDS, WORDS),
        "requirements": st.dictionaries(
            IDS,
            st.one_of(
                WORDS,
                st.none(),
                st.fixed_dictionaries(
                    {},
                    optional={
                        "parent": st.one_of(IDS, st.lists(IDS, max_size=2)),
                        "priority": st.one_of(IDS, st.integers(), st.sampled_from(["no", "1e3"])),
                        "verified_by": st.one_of(IDS, WORDS, st.lists(WORDS, max_size=2)),
                        "source": WORDS,
                    },
                ),
            ),
        ),
        "types": st.dictionaries(WORDS, st.sampled_from(["std_msgs/msg/Bool", "std_srvs/srv/Trigger", "Bool"])),
        "ros": st.fixed_dictionaries({"distro": st.sampled_from(["jazzy", "noetic", "jazy"])}),
    },
)


def draw_element(kind: str) -> st.SearchStrategy[object]:
    """Draw an element of a kind: some of its keys, each with one of the values that people are shown."""
    keys = SCHEMA["$defs"][kind]["properties"]
    drawn = {key: st.sampled_from(list_samples(part)) for key, part in keys.items()}
    return st.one_of(st.none(), st.fixed_dictionaries({}, optional=drawn))


SAMPLED_PROJECTS = st.fixed_dictionaries(
    {"archgen": st.just(1)},
    optional={section: st.dictionaries(IDS, draw_element(kind), max_size=2) for section, kind in SECTION_KINDS.items()},
)
"""Projects of which each element has keys with the schema's examples: every kind and key, whichever there are."""


@settings(max_examples=15, deadline=None, suppress_health_check=[HealthCheck.too_slow, HealthCheck.data_too_large])
@given(st.one_of(PROJECTS, SAMPLED_PROJECTS))
def test_whatever_is_written_packs_to_a_fixed_point(tmp_path_factory: pytest.TempPathFactory, data: object) -> None:
    check_fixed_point(tmp_path_factory, data)


@pytest.mark.slow
@settings(max_examples=150, deadline=None, suppress_health_check=[HealthCheck.too_slow, HealthCheck.data_too_large])
@given(st.one_of(PROJECTS, SAMPLED_PROJECTS))
def test_whatever_is_written_packs_to_a_fixed_point_at_length(
    tmp_path_factory: pytest.TempPathFactory, data: object
) -> None:
    check_fixed_point(tmp_path_factory, data)


def check_fixed_point(tmp_path_factory: pytest.TempPathFactory, data: object) -> None:
    """Pack a project, read the packed file as a project, and pack that: nothing changes."""
    folder = tmp_path_factory.mktemp("robot")
    (folder / "robot.yaml").write_text(json.dumps(data, ensure_ascii=False), encoding="utf-8")
    checked = check_project(folder / "robot.yaml")
    text = text_of(checked)
    (folder / "packed.yaml").write_text(text, encoding="utf-8")
    again = check_project(folder / "packed.yaml")
    assert text_of(again) == text
    assert again.architecture.components == checked.architecture.components
    assert again.architecture.nodes == checked.architecture.nodes
    # A type that ships with archgen stands in the packed file, as the project's own.
    types = {name: replace(each, origin="project") for name, each in checked.architecture.types.items()}
    assert {name: replace(each, origin="project") for name, each in again.architecture.types.items()} == types
    assert again.architecture.properties == checked.architecture.properties
    assert again.architecture.glossary == checked.architecture.glossary
    # A reading error keeps what it may explain quiet; packed, the wrong value is gone, and then it is told.
    if not checked.has_errors:
        assert [d for d in again.findings if d.severity == "error"] == []


def test_what_comments_silence_stays_silent_where_short_forms_are_written_out(tmp_path: Path) -> None:
    """`points: a.b` becomes three lines; the finding points at the last of them."""
    checked = judge_shipped(ROOT / "examples" / "reference_system")
    assert checked.findings == ()
    assert checked.silenced_findings
    again = packed_again(checked, tmp_path)
    assert again.findings == ()
    assert len(again.silenced_findings) == len(checked.silenced_findings)


def test_what_runs_callbacks_is_packed_as_it_was_written(tmp_path: Path) -> None:
    text = """\
archgen: 1
project: {id: r, title: R}
groups:
  g:
    components:
      a: {outputs: {x: std_msgs/msg/Bool, y: std_msgs/msg/Bool}}
      b: {inputs: {x: {from: a.x, freshness: 1 s}, y: a.y, z: a.x}}
nodes:
  a: {implements: a, host: pc, timing: {rate: 10 Hz, wcet: {max: 4 ms, p50: 1 ms, measured: true}, cores: [2, 3], uses: {gpu: {max: 6 ms}, npu: 1 ms}}}
  b: {implements: b, host: pc, threads: 2, scheduling: edf, reentrant: true, timing: {trigger: {match: [x, y], within: 0 ms}, dropped: kept, every: 2, inputs: {z: {wcet: 2 ms}}, deadline: 1 s}}
hosts: {pc: {cores: 4, scheduling: {0: edf, 3: fifo}}}
resources: {gpu: pc, npu: {scheduling: fixed_priority}}
"""
    checked = project(tmp_path / "p", archgen_yaml=text)
    data = yaml.safe_load(text_of(checked))
    assert data["nodes"]["a"]["timing"]["cores"] == [2, 3]
    assert data["nodes"]["a"]["timing"]["wcet"] == {"max": "4 ms", "p50": "1 ms", "measured": True}
    assert (data["nodes"]["b"]["threads"], data["nodes"]["b"]["reentrant"]) == (2, True)
    assert data["hosts"]["pc"]["scheduling"] == {"0": "edf", "3": "fifo"}
    assert data["resources"]["gpu"] == {"host": "pc"}
    again = packed_again(checked, tmp_path)
    for name in ("nodes", "hosts", "resources", "inputs"):
        assert getattr(again.architecture, name) == getattr(checked.architecture, name)


def test_promises_pack_to_the_same(tmp_path: Path) -> None:
    checked = project(
        tmp_path / "p",
        archgen_yaml="archgen: 1\nsources: ['*.yaml']\nproject: {id: r, title: R}\nlibraries: {lib: {component_types: {x: {deprecated: {use: y}}, y: {version: 2}, z: }, types: {L: {deprecated: {use: M}}, M: std_msgs/msg/Bool}}}\n",
        a_yaml="groups: {g: {components: {a: {outputs: {o: {type: L, promise: {rate: 10 Hz, range: [0, 1.50]}}, p: {type: T, version: 1.10, deprecated: {until: 2999-01-01, use: o}}}}, b: {is: lib.x}}}}\n",
        b_yaml="groups: {g: {components: {a: {outputs: {o: {promise: {unit: m, max_age: 1 s}}, p: {deprecated: {}}}}}}}\n"
        "types: {T: {message: std_msgs/msg/Bool, version: 2, deprecated: {use: S}}, S: std_msgs/msg/String}\nnodes: {a: a}\n",
    )
    data = yaml.safe_load(text_of(checked))
    assert data["groups"]["g"]["components"]["a"]["outputs"] == {
        "o": {"type": "L", "promise": {"rate": "10 Hz", "range": [0, 1.5], "unit": "m", "max_age": "1 s"}},
        "p": {"type": "T", "version": "1.10", "deprecated": {"until": "2999-01-01", "use": "o"}},
    }
    # What replaces something of a library belongs to what is used of it.
    assert list(data["libraries"]["lib"]["component_types"]) == ["x", "y"]
    assert list(data["libraries"]["lib"]["types"]) == ["L", "M"]
    again = packed_again(checked, tmp_path)
    for name in ("types", "outputs", "component_types"):
        assert getattr(again.architecture, name) == getattr(checked.architecture, name)
    deprecated, type_deprecated = (
        checked.architecture.component_types["lib.x"].deprecated,
        checked.architecture.types["L"].deprecated,
    )
    assert deprecated
    assert type_deprecated
    assert (deprecated.target, type_deprecated.target) == ("lib.y", "M")


def test_frames_pack_to_the_same(tmp_path: Path) -> None:
    slices = {
        "archgen_yaml": "archgen: 1\nsources: ['*.yaml']\nproject: {id: r, title: R}\n",
        "a_yaml": "groups: {g: {components: {a: {outputs: {o: {type: T, frame: eye}}, frames: {odom: map, '1': odom}}}}}\n"
        "types: {T: {message: std_msgs/msg/Bool, frame: odom}}\nnodes: {a: a}\n",
        "frames_yaml": "frames: {map: , base/link.x: {parent: odom, by: a, rate: 20 Hz}, eye: {parent: 1, static: true}}\n",
        "more_yaml": "frames: {map: {title: 007}, eye: {by: a}}\n",
    }
    checked = project(tmp_path / "p", **slices)
    assert yaml.safe_load(text_of(checked))["frames"] == {
        "map": {"title": "007"},
        "base/link.x": {"parent": "odom", "by": "a", "rate": "20 Hz"},
        "eye": {"parent": "1", "static": True, "by": "a"},
    }
    again = packed_again(checked, tmp_path)
    for name in ("frames", "types", "outputs"):
        assert getattr(again.architecture, name) == getattr(checked.architecture, name)


def test_what_is_written_of_the_start_up_is_packed_as_it_was_written(tmp_path: Path) -> None:
    text = """\
archgen: 1
project: {id: r, title: R}
groups: {g: {components: {a: {outputs: {x: std_msgs/msg/Bool}}, b: {inputs: {x: a.x}}}}}
nodes:
  a: {implements: a, package: p, executable: e, start: {phase: core, ready: {topic: /g/a/x, within: 2 s}, environment: {port: "1", once: no}}}
  b: {implements: b, command: run, start: [a, stage]}
  stage: {kind: program, command: [stage, 1.10, --fast], start: {phase: simulators, ready: {port: 6665}, respawn: true, respawn_delay: 1 s}}
"""
    checked = project(tmp_path / "p", archgen_yaml=text)
    nodes = yaml.safe_load(text_of(checked))["nodes"]
    assert nodes["a"]["start"]["environment"] == {"port": "1", "once": "no"}
    assert (nodes["b"]["command"], nodes["b"]["start"]) == (["run"], {"after": ["a", "stage"]})
    assert nodes["stage"]["command"] == ["stage", "1.10", "--fast"]
    assert nodes["stage"]["start"]["ready"] == {"port": 6665}
    assert nodes["stage"]["start"]["respawn"] is True
    again = packed_again(checked, tmp_path)
    assert again.architecture.nodes == checked.architecture.nodes


def test_names_are_no_keys_of_the_language(tmp_path: Path) -> None:
    text = """\
archgen: 1
project: {id: r, title: R}
groups:
  g: {components: {parameters: {title: 1.10, outputs: {port: {type: T, description: 007}}}}}
types: {T: {fields: {depth: float64, every: int32}}}
nodes:
  n: {implements: g.parameters, package: p, executable: e, start: {environment: {port: 007, depth: 1.10, calls: 0x10, every: 1e3, plain: 007}}}
use_cases: {u: {title: U, actors: {hints: {title: 1.10}, priority: 2.0}}}
glossary: {calls: 0x10}
"""
    checked = project(tmp_path / "p", archgen_yaml=text)
    data = yaml.safe_load(text_of(checked))
    variables = {"port": "007", "depth": "1.10", "calls": "0x10", "every": "1e3", "plain": "007"}
    assert data["nodes"]["n"]["start"]["environment"] == variables
    assert data["use_cases"]["u"]["actors"] == {"hints": {"title": "1.10"}, "priority": {"title": "2.0"}}
    assert data["groups"]["g"]["components"]["parameters"] == {
        "title": "1.10",
        "outputs": {"port": {"type": "T", "description": "007"}},
    }
    assert data["glossary"] == {"calls": "0x10"}
    again = packed_again(checked, tmp_path)
    assert (again.architecture.use_cases, again.architecture.glossary) == (
        checked.architecture.use_cases,
        checked.architecture.glossary,
    )
