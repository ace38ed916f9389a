"""A project whose every text tries to be more than text. The schema says which keys hold text, so none is forgotten."""

from __future__ import annotations

import json
import unicodedata
from typing import Any

from archgen.language.language_tables import ENTRIES, KEYS, SECTION_KINDS
from tests.language_samples import SCHEMA, list_elements

TEXTS = {
    "markup": (
        "<script>alert(1)</script>"
        "](javascript:alert(2)) [a](javascript:alert(3)) ![b](javascript:alert(4)) <javascript:alert(5)>"
        '"><svg onload=alert(6)><img src=x onerror=alert(7)> \'><b onclick="alert(8)">'
        '"]; } digraph { evil [URL="javascript:alert(9)"]; <TABLE><TR><TD HREF="javascript:alert(10)">'
        "A{{7*7}}B {% raw %} ${7*7} <%= 7*7 %> ]]><!-- </title></style></script> &lt;script&gt; \\N\\T\\n"
        "`<script>alert(11)</script>` ```\n<script>alert(12)</script>\n```\n\n# h\n\n<script>alert(13)</script>\n---\n| a |\n"
    ),
    # One text, since one build of all outputs tries all of it: a formula is one only at the beginning.
    "signs": (
        "=cmd|' /C calc'!A0"
        "\x1b[31m\x1b]0;owned\x07\x1b[2J\x9b2J\n::error file=x::owned\n::add-mask::x\r::warning::%0A::error::owned "
        "\u202egpj.exe\u202c \u2066x\u2069 👩‍👩‍👧 🇬🇷 e\u0301 \u0001\u0008\u000b\u001f\u007f\ufffe\uffff\u2028\u2029 \u200b\ufeff"
    ),
    "long": "w" * 5000,
}
"""By what they attack: documents and pages; spreadsheets, terminals, workflows and alphabets; layouts."""
FILLED_KINDS = SCHEMA["$defs"].keys() & {"project", *ENTRIES.values()} & KEYS.keys() - {"parameter", "library"}
"""Kinds that are filled with text: the project, and what is written by ids; values of parameters are data."""
NAMES = {
    *(("node", "name"), ("node", "namespace"), ("container", "name"), ("container", "namespace")),
    *(("view", "show"), ("forbid", "from"), ("forbid", "to"), ("variant", "without"), ("milestone", "needs")),
}
"""Text by the schema, but with a grammar of their own."""


def project(text: str) -> dict[str, Any]:
    """Give a sound project (no errors) with a text in every place that takes one."""
    kind = " ".join(text.split())[:150].strip()
    data: dict[str, Any] = {
        "archgen": 1,
        "project": {"id": "hostile"},
        "ros": {"distro": "jazzy"},
        "report": {
            "chapters": ["docs/evil.md", "groups"],
            "texts": {"docs/evil.md": f"{text}\n\n> {text}\n\n- {text}\n"},
        },
        "partners": {"p": {}},
        "use_cases": {
            "UC-1": {
                "actors": {"who": {}},
                "steps": [
                    {"from": "who", "to": "a.x", "say": text},
                    {"from": "a.x", "to": "b.y", "say": text},
                    {"from": "b.y", "to": "b.y", "say": text},
                ],
            }
        },
        "requirements": {
            "R-0": {},
            "R-1": {"parent": ["R-0"], "verified_by": [f"{kind} {kind}"], "use_cases": ["UC-1"]},
        },
        "component_types": {"t": {"inputs": {"in": {"type": kind}}, "outputs": {"made": {"type": kind}}}},
        "libraries": {
            "lib": {
                "component_types": {"u": {"is": "v"}, "v": {"outputs": {"made": {"type": "Borrowed"}}}},
                "types": {"Borrowed": {"comment": text}},
            },
        },
        "groups": {
            "a": {
                "owner": "p",
                "urls": {text[:60]: "https://example.org/"},
                "components": {"x": _component({}, kind, text)},
            },
            "b": {
                "components": {
                    "y": _component({"in": {"from": "a.x.out"}, "heard": {"from": "a.x.sent"}}, kind, text),
                    "z": {},
                    "s": _compose(),
                    "w": {"is": "lib.u"},
                }
            },
        },
        "nodes": {
            "n": {
                "implements": "a.x",
                "container": "c",
                "publishes": {"sent": {"topic": text}},
                "parameters": {text[:60]: [text, {text[:60]: text}]},
            },
            "m": {"implements": "b.y", "host": "h"},
            "s": {
                "kind": ["program"],
                "host": "h",
                "command": ["stage", text, f"-{text}"],
                "arguments": [text, f"-{text}"],
                "start": {
                    "after": ["n"],
                    "environment": {"WORLD": text},
                    "directory": text,
                    "user": "robot",
                    "ready": {"file": text, "topic": text, "service": text, "log": text, "within": "1 s"},
                },
            },
        },
        "types": {
            kind: {"message": "std_msgs/msg/String"},
            "Fields": {
                "fields": {"x": {"type": "float64"}, "y": {"type": kind}},
                "constants": {"A": {"type": "uint8", "value": "1"}},
            },
        },
        "hosts": {"h": {}, "i": {}},
        "containers": {"c": {"host": "i", "parameters": {text[:60]: [text, {text[:60]: text}]}}},
        "links": {"l": {"connects": ["h", "i", "a.x"], "protocol": "X-_+/"}},
        "frames": {"map": {}, "".join(text.replace("\ufeff", "").split())[:150]: {"parent": "map", "by": "a.x"}},
        "chains": {"k": {"through": ["a.x", "b.y"]}},
        "views": {"v": {"show": "a.x+"}},
        "policies": {"q": {"forbid": {"from": "b.y", "to": "a.x"}}},
        "variants": {
            "s": {
                "without": "b.w",
                "changes": {
                    "nodes": {"n": {"title": text, "parameters": {text[:60]: text}}},
                    "groups": {"a": {"title": text}},
                },
            }
        },
        "properties": {"declared": {"type": "string"}, "chosen": {"of": ["component"], "choices": [text]}},
        "glossary": {kind[:90].strip(): text, "functionality": text},
    }
    for section in SECTION_KINDS:
        data.setdefault(section, {"added": {}})
    for kind_name, element in list(list_elements(data)):
        if kind_name in FILLED_KINDS:
            _fill(element, kind_name, text)
    return data


def _compose() -> dict[str, Any]:
    """Give a composed component with an instance of a component type inside."""
    inner = {"i": {"is": "t", "inputs": {"in": {"from": "self.in"}}}}
    return {"inputs": {"in": {"from": "a.x.out"}}, "outputs": {"made": {"from": "i.made"}}, "components": inner}


def _component(inputs: dict[str, Any], kind: str, text: str) -> dict[str, Any]:
    outside = {"medium": "physical"}
    return {
        "requirements": ["R-1", f"{kind} {kind}"],
        "performance": {"overall": {}},
        "inputs": {**inputs, "felt": {**outside}},
        "outputs": {
            "out": {
                "type": kind,
                "frame": "map",
                "promise": {"rate": "1 Hz", "unit": text, "frame": "map", "range": [0, "1"]},
                "deprecated": {"until": "2999-01-01", "use": "seen"},
            },
            "seen": {**outside, "type": kind},
            "sent": {"type": kind, "medium": "ws+X/1"},
        },
    }


def _fill(element: dict[str, Any], kind: str, text: str) -> None:
    for key, part in SCHEMA["$defs"][kind]["properties"].items():
        sort = part.get("$ref", "").rpartition("/")[2]
        if key not in element and (kind, key) not in NAMES and (key != "external" or element.get("medium")):
            filled: dict[str, dict[str, Any]] = {
                "text": {key: text},
                "prose": {key: text},
                "texts": {key: [text]},
                "properties": {key: {"free": text, "declared": text}},
                "hints": {key: {"program": [text, {text[:60]: text}]}},
            }
            element |= filled.get(sort, {})


def written(data: object) -> str:
    """Write data as JSON, which is YAML; what does not print is escaped."""
    text = json.dumps(data, ensure_ascii=False, indent=1)
    return "".join(c if c == "\n" or c.isprintable() or ord(c) > 0xFFFF else _escaped(c) for c in text)


def _escaped(character: str) -> str:
    return f"\\u{ord(character):04x}"


def controls(said: str) -> list[str]:
    """Name what could move a terminal's cursor, or hide or reorder what it shows."""
    joiners = "\u200c\u200d"
    bad = {c for c in said if unicodedata.category(c) in {"Cc", "Cf", "Zl", "Zp", "Cs"} and c not in f"\n{joiners}"}
    return sorted(unicodedata.name(c, f"U+{ord(c):04X}") for c in bad)
