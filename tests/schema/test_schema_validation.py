"""What differs from the language, in our own words, and what is left of the document then."""

from __future__ import annotations

import pytest

from archgen.schema import validate_document
from archgen.syntax import yaml_parser
from archgen.syntax.yaml_tree import YamlDocument, node_to_data


def document(text: str) -> YamlDocument:
    """Read text that is YAML."""
    found, problems = yaml_parser.parse_yaml("f", text)
    assert found is not None, problems
    return found


def findings(text: str) -> list[str]:
    """Give what is wrong, a line each, in order of place."""
    found = sorted(validate_document(document(text)), key=lambda d: d.sort_key)
    return [f"{d.span.line}:{d.span.column} {d.rule}: {d.message} | {d.help}" for d in found]


UNITS = "a duration is a number and one of the units `ns us ms s min h`, such as `80 ms`"
ID = "an id is lower-case words joined by `_`, such as `object_recognition`, and none of `true false null any all none self`"


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("grops: {}", "1:1 unknown-key: no section is called `grops` | did you mean `groups`?"),
        ("groups: {g: {titel: x}}", "1:14 unknown-key: a functional group has no key `titel` | did you mean `title`?"),
        ("groups: {g: {components: {c: {name: x}}}}", "1:31 unknown-key: a component has no key `name` | the key above is the id; write the name for people as `title`"),
        ("groups: {g: {components: {c: {inputs: [a.b]}}}}", "1:40 wrong-value: an entry of `inputs` cannot be `a.b` | a list of ports names types; where an input comes from is written behind its id: `scan: lidar.scan`"),
        ("groups: {g: {components: {c: {inputs: rgbd}}}}", "1:39 wrong-type: `inputs` is `rgbd`, but must be a mapping or a list | write one `id: ...` line for each below it, or `{}` for none"),
        ("groups: {g: {components: {c: {inputs: {a: {optional: yes}}}}}}", "1:54 wrong-type: `optional` is `yes`, but must be `true` or `false` | write `true`"),
        ("groups: {g: {components: {c: {inputs: {a: {optional: 'true'}}}}}}", "1:54 wrong-type: `optional` is `true` in quotes, which is a text, but must be `true` or `false` | write `true`, without quotes"),
        ("groups: {g: {components: {c: {inputs: {a: {optional: maybe}}}}}}", "1:54 wrong-type: `optional` is `maybe`, but must be `true` or `false` | None"),
        ("sources: '**/*.yaml'", '1:10 wrong-type: `sources` is `**/*.yaml`, but must be a list | write `["**/*.yaml"]`'),
        ("requirements: {R 4: x}", "1:16 wrong-value: `R 4` cannot be an id | such an id is a letter, then letters, digits, `.`, `_` and `-`, for instance `R-1`; write `R-4`"),
        ("nodes: {n: {timing: {rate: 20 ms}}}", "1:28 wrong-value: `rate` has no unit `ms` | write `period: 20 ms`"),
        ("nodes: {n: {timing: {period: 50 Hz}}}", "1:30 wrong-value: `period` has no unit `Hz` | write `rate: 50 Hz`"),
        ("nodes: {n: {timing: {wcet: 12345678901234567890 ms}}}", "1:28 wrong-value: `wcet` has too many digits | at most 18 are read before and after the point"),
        ("links: {l: {bandwidth: 1 Gb/s}}", "1:24 wrong-value: `bandwidth` has no unit `Gb/s` | write `1 Gbit/s`; case counts"),
        ("groups: {g: {components: {c: {role: fliter}}}}", "1:37 wrong-value: `role` cannot be `fliter` | did you mean `filter`?"),
        ("groups: {g: {title: [x]}}", "1:14 wrong-type: `title` is a list, but must be text | write `x`, without brackets"),
        ("groups: [x]", "1:1 wrong-type: `groups` is a list, but must be a mapping | `groups` is keyed by id: write `{x: {}}` instead of a list"),
        ("groups: {ObjectState: x}", f"1:10 wrong-value: `ObjectState` cannot be an id | {ID}; write `object_state`"),
        ("groups: {all: x}", "1:10 wrong-value: `all` cannot be an id: it is a word of the language | choose another, such as `all_parts`: `true`, `false`, `null`, `any`, `all`, `none`, `self` mean something else"),
        ("groups: {g: {owner: CERTH}}", f"1:21 wrong-value: `owner` cannot be `CERTH` | {ID}"),
        ("requirements: {12: x}", "1:16 wrong-value: `12` cannot be an id | such an id is a letter, then letters, digits, `.`, `_` and `-`, for instance `R-1`"),
        ("nodes: {n: {timing: {rate: 10}}}", "1:28 wrong-value: `10` has no unit | write `10 Hz`; a rate is a number and one of the units `Hz kHz`, such as `10 Hz`"),
        ("nodes: {n: {timing: {rate: 10 hz}}}", "1:28 wrong-value: `rate` has no unit `hz` | write `10 Hz`; case counts"),
        ("nodes: {n: {timing: {wcet: 3 sec}}}", "1:28 wrong-value: `wcet` has no unit `sec` | write `3 s`; case counts"),
        ("nodes: {n: {timing: {wcet: soon}}}", f"1:28 wrong-value: `wcet` cannot be `soon` | {UNITS}"),
        ("nodes: {n: {timing: {wcet: -3 ms}}}", f"1:28 wrong-value: `wcet` cannot be negative | {UNITS}"),
        ("nodes: {n: {timing: {wcet: 10 kg}}}", f"1:28 wrong-value: `wcet` has no unit `kg` | {UNITS}"),
        ("nodes: {n: {timing: {period: '100ms '}}}", "1:30 wrong-value: `period` cannot be `100ms` | write `100 ms`"),
        ("nodes: {n: {timing: {period: .nan}}}", f"1:30 wrong-value: `period` cannot be `.nan` | {UNITS}"),
        ("nodes: {n: {timing: {trigger: some}}}", "1:31 wrong-value: `trigger` cannot be `some` | write `[some]`"),
        ("nodes: {n: {timing: {calls: {a: -1}}}}", "1:33 wrong-value: `a` cannot be `-1` | it is at least 0"),
        ("nodes: {n: {kind: [lifecicle]}}", "1:20 wrong-value: an entry of `kind` cannot be `lifecicle` | did you mean `lifecycle`?"),
        ("nodes: {n: {implements: [a, ~]}}", "1:29 wrong-type: an entry of `implements` is empty, but must be text | None"),
        ("nodes: {n: {publishes: {a: {nmae: b}}}}", "1:29 unknown-key: a use of a topic has no key `nmae` | its keys are `topic`, `own_name`, `named_by`, `when`, `message`, `qos`"),
        ("types: {A: {size: 12 KB}}", "1:19 wrong-value: `size` has no unit `KB` | write `12 kB`; case counts: kB is 1000 bytes, KiB is 1024"),
        ("types: {A: image}", "1:12 wrong-value: `A` cannot be `image` | a message is `package/msg/Name`, `package/srv/Name` or `package/action/Name`, such as `sensor_msgs/msg/Image`"),
        ("links: {l: {bandwidth: 10 Mbps}}", "1:24 wrong-value: `bandwidth` has no unit `Mbps` | write `10 Mbit/s`; case counts"),
        ("hosts: {h: {cores: '8'}}", "1:20 wrong-type: `cores` is `8` in quotes, which is a text, but must be a whole number | write `8`, without quotes, point or unit"),
        ("hosts: {h: {cores: 5.0}}", "1:20 wrong-type: `cores` is `5.0`, but must be a whole number | write `5`, without quotes, point or unit"),
        ("hosts: {h: {cores: 0}}", "1:20 wrong-value: `cores` cannot be `0` | it is at least 1"),
        ("hosts: {h: {cores: 123456789012345678901234567890}}", "1:20 wrong-value: `cores` cannot be `123456789012345678901234567890` | it is at most 1000000"),
        ("rules: {unread-output: warn}", "1:24 wrong-value: `unread-output` cannot be `warn` | it is one of `note`, `off`, `warning`, `error`"),
        ("archgen: 2", "1:10 wrong-value: this archgen reads version 1 of the language, not `2` | write `1`"),
        ("groups: {g: {urls: {a: 'javascript:x'}}}", "1:24 wrong-value: `a` cannot be `javascript:x` | an address begins with `https://`, `http://` or `mailto:`, and holds no blank, `<`, `>` or `\"` (write `%3C`, `%3E`, `%22`); a file of the repository is its path from the project's folder, with `/` and without blanks"),
        ("generate: [ros2_cpp, start]", "1:1 wrong-type: `generate` is a list, but must be a mapping | its keys are `into`, `backends`: write `{backends: {ros2_cpp: {}, start: {}}}`"),
        ("generate: ros2_cpp", "1:11 wrong-type: `generate` is `ros2_cpp`, but must be a mapping | its keys are `into`, `backends`: write `{backends: {ros2_cpp: {}}}`"),
        ("generate: {backends: [ros2_cpp, {start: {image: x}}]}", "1:12 wrong-type: `backends` is a list, but must be a mapping | `backends` is keyed by id: write `{ros2_cpp: {}, start: {...}}` instead of a list"),
        ("generate: {backends: [[a], {b c: 1}]}", "1:12 wrong-type: `backends` is a list, but must be a mapping | `backends` is keyed by id: write `id: ...` lines instead of a list"),
        ("groups: {g: {tags: safety}}", "1:20 wrong-type: `tags` is `safety`, but must be a list | write `[safety]`"),
    ],
)  # fmt: skip
def test_wording(text: str, expected: str) -> None:
    assert findings(text) == [expected]


def test_keys_that_look_like_numbers() -> None:
    assert findings("hosts: {00: {cors: 1}, +1: {cores: x}, 7: [x]}\ngroups: {a: {urls: {1: 'f:x'}, 0: y}}") == [
        f"1:9 wrong-value: `00` cannot be an id | {ID}",
        "1:14 unknown-key: a host has no key `cors` | did you mean `cores`?",
        f"1:24 wrong-value: `+1` cannot be an id | {ID}",
        "1:36 wrong-type: `cores` is `x`, but must be a whole number | write a number without unit",
        "1:40 wrong-type: `7` is a list, but must be text or a mapping | its keys are `title`, `cores`, `scheduling`, `description`, `address`, `discovery_server`, `environment`, `tags`, `properties`, `hints`",
        f"1:40 wrong-value: `7` cannot be an id | {ID}",
        "2:24 wrong-value: `1` cannot be `f:x` | an address begins with `https://`, `http://` or `mailto:`, and holds no blank, `<`, `>` or `\"` (write `%3C`, `%3E`, `%22`); a file of the repository is its path from the project's folder, with `/` and without blanks",
        "2:32 unknown-key: a functional group has no key `0` | its keys are `title`, `description`, `owner`, `tags`, `urls`, `layout`, `components`, `autoconnect`, `properties`, `hints`",
    ]


def test_all_at_once_each_with_its_element() -> None:
    text = "groups:\n  g:\n    components:\n      c: {role: x, owner: Y}\nnodes:\n  n: {host: Z}\n"
    found = sorted(validate_document(document(text)), key=lambda d: d.sort_key)
    assert [(d.element, d.span.line, d.rule) for d in found] == [
        ("g.c", 4, "wrong-value"),
        ("g.c", 4, "wrong-value"),
        ("n", 6, "wrong-value"),
    ]


@pytest.mark.parametrize(
    ("text", "left"),
    [
        ("groups: {g: {title: x, titel: y}}", {"groups": {"g": {"title": "x"}}}),
        ("groups: {g: {components: {c: [x]}}}", {"groups": {"g": {"components": {"c": None}}}}),
        ("groups: {Big-Group: {title: x}}", {"groups": {"Big-Group": {"title": "x"}}}),
        ("groups: {../../etc: {title: x}}", {"groups": {}}),
        ("nodes: {n: {implements: [1], kind: [x], tags: []}}", {"nodes": {"n": {"implements": [], "tags": []}}}),
        ("nodes: {n: {implements: [a, b c]}}", {"nodes": {"n": {"implements": ["a"]}}}),
        ("types: {A: {message: x, comment: y}}", {"types": {"A": {"comment": "y"}}}),
        ("groups: 3\nhosts: {h: {}}", {"hosts": {"h": {}}}),
    ],
)
def test_what_is_wrong_is_taken_out(text: str, left: object) -> None:
    read = document(text)
    assert validate_document(read) != ()
    assert node_to_data(read.root) == left
    assert validate_document(read) == () or "Big-Group" in text


@pytest.mark.parametrize(
    "text",
    [
        "project: {title: No, version: 1.10, id: x1}",
        "groups: {g: 2024, h: {title: true}, i: }",
        "nodes: {n: {parameters: {a: .nan, b: [1, {c: 0x10}], Any Key: 99999999999999999999999}}}",
        "nodes: {n: {timing: {bcet: 0 ms, calls: {a: 0.5, b: 1/3, c: 2}, trigger: {all: [a]}, every: 3}}}",
        "groups: {g: {components: {c: {performance: {accuracy: 90 %, recall: {execution_time: 3 ms}}}}}}",
        "groups: {g: {components: {c: {performance: {accuracy: {accuracy: 90 %}}}}}}",
        "types: {Grasp on request: ramcip_msgs/action/PlanGrasp, 'Übergabe': sensor_msgs/Image}",
        "chains: {c: [a.b, d]}\nlinks: {l: [a, b]}\nviews: {v: tag:safety}",
    ],
)
def test_what_is_right_stays_silent(text: str) -> None:
    assert findings(text) == []
