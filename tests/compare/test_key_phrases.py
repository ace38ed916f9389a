"""The sentence about a changed key."""

from __future__ import annotations

import pytest

from archgen.compare import Change
from archgen.compare.key_phrases import describe_key_change, format_value, shorten_text
from archgen.diagnostics.common_wording import join_words

LONG = "x" * 81


@pytest.mark.parametrize(
    ("element", "key", "before", "after", "text"),
    [
        ("host pc", "cores", 4, 2, "host `pc`: cores 4 → 2"),
        ("host pc", "cores", None, 2, "host `pc`: cores set to 2"),
        ("host pc", "cores", 4, None, "host `pc`: cores no longer given (it was 4)"),
        ("component g.a", "role", "sink", "source", "`g.a` now is a `source` instead of `sink`"),
        ("component g.a", "role", None, "source", "`g.a`: role set to `source`"),
        ("component g.a", "role", "sink", None, "`g.a`: role no longer given (it was `sink`)"),
        ("use_case UC.1", "title", "a", "b", "use case `UC.1`: title `a` → `b`"),
        ("message a/msg/B", "fields", ["x"], ["y"], "message `a/msg/B`: `x` is called `y` now"),
        ("node n", "container", None, "box", "node `n` now runs in the container `box`"),
        ("node n", "container", "box", None, "node `n` no longer runs in the container `box`"),
        ("node n", "container", "box", "bin", "node `n` now runs in the container `bin` instead of `box`"),
        ("node n", "host", None, "pc", "node `n`: host set to `pc`"),
        ("group g", "owner", "a", "b", "group `g` now belongs to `b` instead of `a`"),
        ("project robot", "version", "1", "2", "the project now is version `2` instead of `1`"),
        ("project robot", "distro", "humble", "jazzy", "the project: ROS distribution `humble` → `jazzy`"),
        ("project robot", "rules.late-chain", None, "off", "the project: severity of the rule `late-chain` set to `off`"),
        ("project robot", "review.main", "a", "b", "the project: review main `a` → `b`"),
        ("node n", "parameters.a.b_c", 1, True, "node `n`: parameter `a.b_c` 1 → true"),
        ("node n", "parameter_files", ["a"], ["a", "b"], "node `n`: parameter files `b` added"),
        ("component g.a", "timing.wcet", "1 ms", None, "`g.a`: worst case execution time no longer given (it was `1 ms`)"),
        ("component g.a", "timing.bcet", "1 ms", "2 ms", "`g.a`: best case execution time `1 ms` → `2 ms`"),
        ("component g.a", "timing.rate", "1 Hz", "2 Hz", "`g.a`: rate `1 Hz` → `2 Hz`"),
        ("component g.a", "timing.response", "1 ms", "2 ms", "`g.a`: stated response time `1 ms` → `2 ms`"),
        ("component g.a", "timing.outputs.x.max_gap", "1 s", "2 s", "`g.a`: outputs x max gap `1 s` → `2 s`"),
        ("node n", "timing.g.a.wcet", "1 ms", "2 ms", "node `n`: g a wcet `1 ms` → `2 ms`"),
        ("link l", "latency.best", "1 ms", "2 ms", "link `l`: best latency `1 ms` → `2 ms`"),
        ("policy p", "forbid.to", "a", "b", "policy `p`: forbidden target `a` → `b`"),
        ("output g.a.x", "type", "T", "U", "`g.a.x` now carries `U` instead of `T`"),
        ("output g.a.x", "type", "T", None, "`g.a.x` now carries nothing named instead of `T`"),
        ("output g.a.x", "type", None, "T", "`g.a.x` now carries `T`"),
        ("input g.a.x", "type", "T", "U", "`g.a.x` now expects `U` instead of `T`"),
        ("input g.a.x", "optional", None, True, "`g.a.x` is optional now"),
        ("input g.a.x", "optional", True, None, "`g.a.x` is no longer optional"),
        ("input g.a.x", "medium", None, "physical", "`g.a.x`: medium set to `physical`"),
        ("component g.a", "description", "a", "b", "`g.a`: description `a` → `b`"),
        ("component g.a", "description", None, "b", "the description of `g.a` is new: `b`"),
        ("component g.a", "description", "a", None, "the description of `g.a` is gone: `a`"),
        ("component g.a", "description", "x" * 80, "b", f"`g.a`: description `{'x' * 80}` → `b`"),
        ("component g.a", "description", LONG, "b", f"the description of `g.a` is rewritten: `{'x' * 60}…` → `b`"),
        ("component g.a", "description", "a\nb", "a\nc\nd", "the description of `g.a` is rewritten: `a b` → `a c d`"),
        ("component g.a", "description", "a\nb", "a", "the description of `g.a` is rewritten: `a b` → `a`"),
        ("component g.a", "description", "a\nb", "b\na", "the description of `g.a` is rewritten: `a b` → `b a`"),
        ("component g.a", "description", "a\nb", None, "the description of `g.a` is gone: `a b`"),
        ("component g.a", "description", "a\nb", "a b\n\n", "the description of `g.a` has its lines broken in another way"),
        ("chapter a.md", "text", "a\nb", "a\nc\nd", "the text of chapter `a.md` changed: 2 lines added and 1 line removed"),
        ("chapter a.md", "text", "a\nb", "b\na", "the text of chapter `a.md` has its lines in another order"),
        ("project p", "review.accepted.my_msgs/msg/Row_2", None, "fine", "the project: what is accepted of `my_msgs/msg/Row_2` set to `fine`"),
        ("component g.a", "timing.calls.find_it", 1, 2, "`g.a`: calls of `find_it` 1 → 2"),
        ("chapter a.md", "text", "a", "b", "the text of chapter `a.md` is rewritten"),
        ("port n.publishes.x", "topic", ["/a"], ["/b"], "`n.publishes.x`: topic `/a` → `/b`"),
        ("port n.serves.x", "topic", ["/a"], ["/b"], "`n.serves.x`: name `/a` → `/b`"),
        ("port n.calls.x", "topic", None, ["/b"], "`n.calls.x`: name `/b` added"),
        ("port n.calls.x", "message", None, "a/srv/B", "`n.calls.x`: message set to `a/srv/B`"),
        ("port n.publishes.x", "qos", {"depth": 5, "lease_duration": None}, {"depth": 1, "lease_duration": "1 s"}, "`n.publishes.x`: QoS depth 5 → 1 and lease duration unlimited → `1 s`"),
        ("group g", "tags", ["a"], ["a", "b"], "group `g` now has the tag `b`"),
        ("group g", "tags", ["a", "b"], ["c"], "group `g` now has the tag `c` and no longer has the tag `a` and `b`"),
        ("group g", "tags", ["a"], ["b"], "group `g`: tags `a` → `b`"),
        ("group g", "tags", ["a"], None, "group `g` no longer has the tag `a`"),
        ("group g", "co_owners", ["a", "b"], ["b", "c"], "group `g`: further owners `c` added, `a` removed"),
        ("chain c", "through", ["a", "b"], ["b", "a"], "chain `c`: through are now `b` and `a`, in this order"),
        ("node n", "kind", ["driver"], ["driver", "lifecycle"], "node `n` is now `lifecycle`"),
        ("requirement R", "use_cases", None, list("abcdef"), "requirement `R` now belongs to `a`, `b`, `c`, `d`, `e` and `f`"),
        ("requirement R", "use_cases", None, list("abcdefg"), "requirement `R` now belongs to `a`, `b`, `c`, `d`, `e`, `f` and 1 more"),
        ("project robot", "chapters", ["a"], ["a", *"bcdefghi"], "the project: chapters `b`, `c`, `d`, `e`, `f`, `g` and 2 more added"),
        ("type a.b", "size", "1 B", "2 B", "type `a.b`: size `1 B` → `2 B`"),
        ("type T", "status", None, "planned", "type `T`: status set to `planned`"),
        ("node n", "status", "planned", "existing", "node `n` now is `existing` instead of `planned`"),
        ("chain c", "deadline", "1 s", "2 s", "chain `c` now must end within `2 s` instead of `1 s`"),
    ],
)  # fmt: skip
def test_sentences(element: str, key: str, before: object, after: object, text: str) -> None:
    kind, name = element.split(" ")
    assert describe_key_change(Change("changed", kind, name, key=key, before=before, after=after)) == text


def test_values_in_sentences() -> None:
    values: tuple[object, ...] = (None, True, 2, 2.5, "a `b`\nc", ["a", 1], [])
    assert [format_value(value) for value in values] == [
        "unlimited",
        "true",
        "2",
        "2.5",
        "`a 'b' c`",
        "`a` and 1",
        "none",
    ]


def test_texts_are_cut_to_one_line_of_80_characters() -> None:
    assert shorten_text("x" * 80) == "x" * 80
    assert shorten_text(LONG) == "x" * 79 + "…"


def test_words_are_joined() -> None:
    assert [join_words(list("abc"[:n])) for n in range(4)] == ["", "a", "a and b", "a, b and c"]
