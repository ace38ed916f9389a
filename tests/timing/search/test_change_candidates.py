"""The settings that are tried for one element, in their order: each as `--set` writes it."""

from __future__ import annotations

import pytest

from archgen.timing.run_analysis import analyse_architecture
from archgen.timing.search.change_candidates import list_settings
from tests.timing.random_systems import architecture
from tests.timing.sketches import sketch


def _list_texts(text: str, *names: str) -> list[str]:
    model = architecture(text)
    analysis = analyse_architecture(model)
    settings = list_settings(model, analysis, [analysis.system.activities[name] for name in names])
    return ["+".join(map(str, changes)) for changes in settings]


def _load(percent: int, rest: str = "") -> str:
    return f"period: 100 ms, wcet: {percent} ms{rest}"


@pytest.mark.parametrize(
    ("own", "others", "settings"),
    [
        ("", {"b @p": ""}, ["a.timing.priority=1"]),
        ("", {"b @p": ", priority: 5", "c @p": ", priority: 3"}, ["a.timing.priority=6"]),
        ("", {"b @p": ", priority: 5", "c @q": ", priority: 50"}, ["a.timing.priority=6"]),
        (", priority: 5", {"b @p": ", priority: 5"}, ["a.timing.priority=6"]),
        (", priority: 6", {"b @p": ", priority: 5"}, []),
        ("", {"b @p": ", priority: 98"}, ["a.timing.priority=99"]),
        ("", {"b @p": ", priority: 99"}, []),
    ],
)
def test_a_priority_above_all_others_of_the_host(own: str, others: dict[str, str], settings: list[str]) -> None:
    nodes = {"a @p": _load(1, own)} | {head: _load(1, rest) for head, rest in others.items()}
    assert _list_texts(sketch(nodes, "", "hosts: {p: {cores: 1}, q: {cores: 1}}"), "a") == settings


@pytest.mark.parametrize(
    ("cores", "own", "others", "core"),
    [
        (1, "", {"b @p": _load(9, ", core: 0")}, None),
        (2, "", {"b @p": _load(9, ", core: 0")}, 1),
        (2, ", core: 1", {"b @p": _load(9, ", core: 0")}, None),
        (2, ", core: 0", {"b @p": _load(9, ", core: 1")}, None),
        (2, ", core: 0", {"b @p": _load(9, ", core: 0")}, 1),
        # The last core that nothing is pinned to is left to what is loose.
        (2, "", {"b @p": _load(9, ", core: 0"), "c @p": _load(1)}, None),
        (3, "", {"b @p": _load(9, ", core: 0"), "c @p": _load(1)}, 1),
        (2, "", {"b @p": _load(9, ", core: 0"), "c @q": _load(1)}, 1),
        # The least loaded one, the first of several.
        (
            3,
            "",
            {"b @p": _load(30, ", core: 0"), "c @p": _load(9, ", core: 1"), "d @p": _load(20, ", core: 2")},
            1,
        ),
        (2, "", {"b @p": _load(9, ", core: 0"), "c @p": _load(9, ", core: 1")}, 0),
        (2, "", {"b @p": _load(8, ", core: 0"), "c @p": _load(9, ", core: 1"), "d @p": _load(3, ", core: 0")}, 1),
    ],
)
def test_the_core_on_which_least_is_pinned(cores: int, own: str, others: dict[str, str], core: int | None) -> None:
    text = sketch({"a @p": _load(1, own), **others}, "", f"hosts: {{p: {{cores: {cores}}}, q: {{cores: 1}}}}")
    settings = _list_texts(text, "a")
    assert settings == ["a.timing.priority=1", *([] if core is None else [f"a.timing.core={core}"])]


@pytest.mark.parametrize(
    ("members", "threads", "settings"),
    [
        ("ab", 1, ["box.threads=2"]),
        ("abc", 1, ["box.threads=2", "box.threads=3"]),
        ("abc", 2, ["box.threads=3"]),
        ("abc", 3, ["box.threads=4"]),
        ("a", 1, []),
    ],
)
def test_more_threads_of_a_container(members: str, threads: int, settings: list[str]) -> None:
    nodes = {f"{name} +box": _load(1) for name in members}
    text = sketch(nodes, "", f"hosts: {{p: {{cores: 1}}}}\ncontainers: {{box: {{threads: {threads}, host: p}}}}")
    assert _list_texts(text, "a") == ["a.timing.priority=1", *settings]


_ONE_NODE = """
groups: {g: {components: {b: {outputs: {out: D}, timing: {TIMING}}, c: {outputs: {out: D}, timing: {TIMING}}}}}
nodes: {n: {implements: [g.b, g.c], host: pMORE}}
types: {D: {message: std_msgs/msg/String}}
hosts: {p: {cores: 1}}
""".replace("TIMING", "period: 100 ms, wcet: 1 ms")


@pytest.mark.parametrize(
    ("more", "settings"),
    [
        # One thread and one group: both have to change.
        ("", ["n.threads=2+n.callback_groups.b=g.b", "n.threads=2+n.reentrant=true"]),
        (", threads: 2", ["n.callback_groups.b=g.b", "n.reentrant=true"]),
        # Several groups already: threads alone are enough.
        (", callback_groups: {x: [g.b]}", ["n.threads=2"]),
        (", threads: 2, callback_groups: {x: [g.b]}", ["n.threads=3"]),
        (", threads: 2, callback_groups: {b: [g.b, g.c]}", ["n.reentrant=true"]),
        (", threads: 2, reentrant: true", ["n.threads=3"]),
    ],
)
def test_threads_and_callback_groups_of_a_node(more: str, settings: list[str]) -> None:
    found = _list_texts(_ONE_NODE.replace("MORE", more), "n.b")
    assert [text for text in found if "priority" not in text] == settings


def test_a_node_and_a_container_of_one_name_are_told_apart() -> None:
    text = sketch(
        {"a +box": _load(1), "b +box": _load(1), "box @p": _load(1)},
        "",
        "hosts: {p: {cores: 1}}\ncontainers: {box: {threads: 1, host: p}}",
    )
    assert _list_texts(text, "a") == ["a.timing.priority=1", "containers.box.threads=2"]


def test_single_changes_come_before_pairs_and_none_comes_twice() -> None:
    assert _list_texts(_ONE_NODE.replace("MORE", ""), "n.b", "n.b")[-2:] == [
        "n.threads=2+n.callback_groups.b=g.b",
        "n.threads=2+n.reentrant=true",
    ]


@pytest.mark.parametrize(
    ("program", "texts"),
    [
        ("", ["a.timing.priority=1", "box.threads=2"]),
        # As many threads as are asked for: another one helps nobody.
        (", executable: component_container_mt", ["a.timing.priority=1"]),
    ],
)
def test_threads_that_nobody_wrote_are_those_of_the_program(program: str, texts: list[str]) -> None:
    rest = f"hosts: {{p: {{cores: 1}}}}\ncontainers: {{box: {{host: p{program}}}}}"
    text = sketch({"a +box": _load(1), "b +box": _load(1)}, "", rest)
    assert _list_texts(text, "a") == texts
