"""Mistakes in pass files: each is told with its line, its column and what to do."""

from __future__ import annotations

from pathlib import Path

import pytest

from archgen.passes.patterns import pattern_registry
from archgen.passes.patterns.pattern_registry import find_known_passes
from archgen.pipeline import check_project
from tests.passes.patterns.transforming import read

FIND = "rules: [{find: {components: {$c: {tags: [a]}}}, "


def _said(text: str) -> list[str]:
    return [f"{d.span.line}:{d.span.column} {d.message} | {d.help or ''}" for d in read(text).diagnostics]


@pytest.mark.parametrize(
    ("text", "wanted"),
    [
        ("title: x\nruels: []\n", "2:1 `ruels` is no key of a pass | did you mean `rules`?"),
        ("title: x\n", "1:1 a pass has a list of rules | write `rules:` and below it `- find: {...}`"),
        ("title: x\nrules: {}\n", "2:1 a pass has a list of rules | write `rules:` and below it `- find: {...}`"),
        (
            "rules: [{find: {components: {$c: }}, drop: {components: {$c: }}}]\n",
            "1:1 a pass has a title | write `title: What it does.`",
        ),
        ("title: [a]\n" + FIND + "drop: {components: {$c: }}}]", "1:8 `title` is a text | "),
        ("title: x\nrules: [a]\n", "2:9 a rule is a mapping with `find` and what it writes | "),
        (
            "title: x\nrules:\n  - add: {components: {a: {tags: [x]}}}\n",
            "3:5 a rule without `find` finds nothing | write what it looks for: `find: {components: {$c: {...}}}`",
        ),
        (
            "title: x\nrules:\n  - fnd: {}\n    find: {components: {$c: }}\n    drop: {components: {$c: }}\n",
            "3:5 `fnd` is no key of a rule | did you mean `find`?",
        ),
        (
            "title: x\nrules:\n  - find: {components: {$c: {tags: [a]}}}\n",
            "3:5 a rule that changes nothing that it finds comes to no end | write `add`, `set` or `drop`",
        ),
        (
            "title: x\nrules:\n  - find: {component: {$c: }}\n    drop: {components: {a: }}\n",
            "3:12 `component` is no key of `find` | did you mean `components`?",
        ),
        (
            "title: x\nrules:\n  - find: {components: {$c: {inptus: }}}\n    drop: {components: {$c: }}\n",
            "3:30 `inptus` is no key of a component | did you mean `inputs`?",
        ),
        (
            "title: x\nrules:\n  - find: {components: {$c: {inputs: {$p: {tpye: X}}}}}\n    drop: {components: {$c: }}\n",
            "3:44 `tpye` is no key of an input | did you mean `type`?",
        ),
        (
            "title: x\nrules:\n  - find: {types: {$t: {mesage: }}}\n    drop: {types: {$t: }}\n",
            "3:25 `mesage` is no key of a type | did you mean `message`?",
        ),
        (
            "title: x\nrules:\n  - find: {components: {$c: {components: {a: }}}}\n    drop: {components: {$c: }}\n",
            "3:30 components do not stand inside of one another here | what stands inside has a path of its own: `$inner: {in: $outer}`",
        ),
        (
            "title: x\n" + FIND + "add: {components: {$d: {tags: [b]}}}}]",
            "2:68 nothing binds `$d` | did you mean `$c`?",
        ),
        (
            "title: x\n" + FIND + "add: {components: {$c: {tags: ['${other}_b']}}}}]",
            "2:73 nothing binds `$other` | bind it in `find`, or with `let`",
        ),
        (
            "title: x\n" + FIND + "add: {components: {$c: {tags: [$_]}}}}]",
            "2:73 `$_` stands for anything, and cannot be written | give it a name in `find`",
        ),
        (
            "title: x\n" + FIND + "set: {components: {$_: {title: x}}}}]",
            "2:68 `$_` stands for anything: nobody knows where to write | ",
        ),
        (
            "title: x\n" + FIND + "unless: {components: {$o: {in: $c}}}, add: {components: {$o: {tags: [b]}}}}]",
            "2:106 `$o` is bound in `unless` only: where the rule writes, there is none | bind it in `find`",
        ),
        (
            "title: x\n" + FIND + "where: $d != a, drop: {components: {$c: }}}]",
            "2:56 nothing binds `$d` | did you mean `$c`?",
        ),
        (
            "title: x\n" + FIND + "where: $c, drop: {components: {$c: }}}]",
            "2:56 `$c` compares nothing | write one of `==`, `!=`, `in`, `starts with`, `has` between two values",
        ),
        (
            "title: x\n" + FIND + "where: $c startswith a, drop: {components: {$c: }}}]",
            "2:56 `startswith` is no comparison | did you mean `starts with`?",
        ),
        (
            "title: x\n" + FIND + "where: $c == a b, drop: {components: {$c: }}}]",
            "2:56 `b` is too much in `$c == a b` | texts with blanks stand in quotes",
        ),
        (
            "title: x\n" + FIND + "where: [[a]], drop: {components: {$c: }}}]",
            "2:57 `where` is a comparison, or a list of them | as in `where: $type != Pose`",
        ),
        (
            "title: x\n" + FIND + "let: {$n: snaek($c)}, drop: {components: {$c: }}}]",
            "2:59 no function named `snaek` | did you mean `snake`?",
        ),
        (
            "title: x\n" + FIND + "let: {$n: 'snake($c, $c)'}, drop: {components: {$c: }}}]",
            "2:59 `snake` takes 1 value, not 2 | ",
        ),
        (
            "title: x\n" + FIND + "let: {$n: 'is_a($c, x)'}, drop: {components: {$c: }}}]",
            "2:59 `is_a` says yes or no, and stands behind `where` | ",
        ),
        (
            "title: x\n" + FIND + "let: {$c: snake($c)}, drop: {components: {$c: }}}]",
            "2:55 `$c` is bound already: `let` gives it a second meaning | choose another name",
        ),
        (
            "title: x\n" + FIND + "let: {n: snake($c)}, drop: {components: {$c: }}}]",
            "2:55 `n` is no variable | write `$n`",
        ),
        (
            "title: x\n" + FIND + "let: {$n: snake($m), $m: snake($c)}, drop: {components: {$c: }}}]",
            "2:55 nothing binds `$m` | did you mean `$c`?",
        ),
        (
            "title: x\nrules: [{find: {components: {$c: }, types: {$c: }}, drop: {components: {$c: }}}]",
            "2:45 `$c` is a component and a type: nothing is both | use two variables",
        ),
        (
            "title: x\n" + FIND + "set: {components: {$c: {title: a}}}, add: {components: {$c: {title: b}}}}]",
            "2:110 `add` contradicts `set` at the same place | `set` alone replaces a value",
        ),
        (
            "title: x\n" + FIND + "set: {components: {$c: {id: other}}}}]",
            "2:73 `id` follows from the path, and is not written | a new component stands where its path says: `$outer.name`",
        ),
        (
            "title: x\nneeds: [flatt]\n" + FIND + "drop: {components: {$c: }}}]",
            "2:9 `flatt` is nothing that passes leave true | did you mean `flat`?",
        ),
        (
            "title: x\nrules: [{find: {components: {$c: {node: {host: pc}}}}, drop: {components: {$c: }}}]",
            (
                "2:42 `host` below `node` is only what stands at the component itself, and not where it runs"
                " | `host` of the component holds wherever it is written"
            ),
        ),
        (
            "title: x\nrules: [{find: {chains: {$c: }}, drop: {components: {$c: }}}]",
            (
                "2:17 `chains` is no key of `find` | `find` has `components`, `types`, `nodes`, `hosts`, `containers`,"
                " `links`, `topics`, `connections`"
            ),
        ),
        (
            "title: x\nrules: [{find: {connections: {$c: {crosses: hosts}}}, drop: {nodes: {n: }}}]",
            "2:45 `hosts` is nothing that a connection crosses | did you mean `host`?",
        ),
        (
            "title: x\n" + FIND + "set: {topics: {/x: {flow: topic}}}}]",
            (
                "2:64 a topic follows from what is connected, and is not written"
                " | a topic is named at a node: `publishes: {$port: {topic: ...}}`"
            ),
        ),
        ("a: [\n", ""),
    ],
)
def test_a_mistake_has_place_and_words(text: str, wanted: str) -> None:
    said = _said(text)
    assert read(text).read_pass is None
    assert said
    if wanted:
        assert said[0] == wanted


def test_what_is_too_large_is_told() -> None:
    rule = "{find: {components: {$c: }}, drop: {components: {$c: }}}"
    assert _said("title: x\nrules: [" + rule + "]") == []
    assert _said("title: x\nrules: [" + ", ".join([rule] * 201) + "]") == [
        "2:1 201 rules; a pass has at most 200 | write several passes"
    ]
    assert "more than 20,000 keys and values" in _said("title: x\nrules: [" + ", ".join(["{a: b}"] * 10_001) + "]")[0]
    assert "200,000 are read" in _said("title: " + "x" * 200_001)[0]
    deep = "{a: " * 40 + "b" + "}" * 40
    assert "30 levels" in " ".join(
        _said("title: x\nrules: [{find: {components: {$c: {hints: " + deep + "}}}, drop: {components: {$c: }}}]")
    )
    long = "where: '" + "[" * 60 + "', "
    assert "deep inside of one another" in " ".join(_said("title: x\n" + FIND + long + "drop: {components: {$c: }}}]"))
    assert "1,000 are read" in " ".join(
        _said("title: x\n" + FIND + "where: '" + "a" * 1001 + "', drop: {components: {$c: }}}]")
    )
    # Each is looked for inside of the one before: without a limit Python's own depth would end it.
    ports = ", ".join(f"p{number}: {{type: $t}}" for number in range(1200))
    wide = f"{{components: {{$c: {{outputs: {{{ports}}}}}}}}}"
    (found,) = _said(f"title: x\nrules: [{{find: {wide}, drop: {{components: {{$c: }}}}}}]")
    assert found == "2:17 `find` has 3,603 keys and values; at most 300 are looked for | write several rules"


def test_aliases_that_grow_are_told() -> None:
    lines = ["title: x", "a: &a0 [x, x, x, x, x, x, x, x, x, x]"]
    lines += [f"a{n}: &a{n} [{', '.join([f'*a{n - 1}'] * 10)}]" for n in range(1, 9)]
    assert _said("\n".join(lines))


def test_a_projects_passes_are_judged_by_check_and_are_no_slices(tmp_path: Path) -> None:
    (tmp_path / "passes").mkdir()
    (tmp_path / "archgen.yaml").write_text("archgen: 1\n")
    (tmp_path / "passes" / "good.yaml").write_text(
        "title: Good\nrules: [{find: {components: {$c: {tags: [a]}}}, drop: {components: {$c: }}}]\n"
    )
    assert [d.rule for d in check_project(tmp_path).findings] == []
    (tmp_path / "passes" / "bad.yaml").write_text("title: Bad\nrules: [{find: {components: {$c: }}}]\n")
    (found,) = check_project(tmp_path).findings
    assert (found.rule, found.span.file, found.span.line) == ("wrong-pass", "passes/bad.yaml", 2)
    (tmp_path / "archgen.yaml").write_text("archgen: 1\nsources: ['**/*.yaml']\n")
    assert [d.rule for d in check_project(tmp_path).findings] == ["wrong-pass"]


def test_slices_in_a_folder_called_passes_stay_slices(tmp_path: Path) -> None:
    (tmp_path / "passes").mkdir()
    (tmp_path / "archgen.yaml").write_text("archgen: 1\n")
    (tmp_path / "passes" / "night.yaml").write_text("groups: {night: {title: Night}}\n")
    (tmp_path / "passes" / "severities.yaml").write_text("rules: {unread-output: note}\n")
    checked = check_project(tmp_path)
    assert list(checked.architecture.groups) == ["night"]
    assert [d.rule for d in checked.findings if d.rule == "wrong-pass"] == []


def test_a_pass_behind_a_link_is_refused(tmp_path: Path) -> None:
    project = tmp_path / "project"
    (project / "passes").mkdir(parents=True)
    (project / "archgen.yaml").write_text("archgen: 1\n")
    (tmp_path / "other.yaml").write_text("title: x\n")
    (project / "passes" / "linked.yaml").symlink_to(tmp_path / "other.yaml")
    files = check_project(project).loaded_project.files
    (found,) = pattern_registry.list_project_passes(files)
    assert found.read_pass is None
    assert [d.message for d in found.diagnostics] == ["a pass is reached by a link; it stands in the project itself"]
    (tmp_path / "elsewhere").mkdir()
    (tmp_path / "elsewhere" / "x.yaml").write_text(
        "title: x\nrules: [{find: {components: {$c: }}, drop: {components: {$c: }}}]\n"
    )
    linked = tmp_path / "linked"
    linked.mkdir()
    (linked / "archgen.yaml").write_text("archgen: 1\n")
    (linked / "passes").symlink_to(tmp_path / "elsewhere")
    assert all(
        each.read_pass is None
        for each in pattern_registry.list_project_passes(check_project(linked).loaded_project.files)
    )


def test_a_pass_that_cannot_be_called_so_hides_none_that_ships(tmp_path: Path) -> None:
    (tmp_path / "passes").mkdir()
    (tmp_path / "archgen.yaml").write_text("archgen: 1\n")
    text = "title: Mine\nrules: [{find: {components: {$c: {tags: [a]}}}, drop: {components: {$c: }}}]\n"
    for name in ("rules.envelope", "envelope", "Mine"):
        (tmp_path / "passes" / f"{name}.yaml").write_text(text)
    checked = check_project(tmp_path)
    assert [(each.span.file, each.message) for each in checked.findings] == [
        ("passes/envelope.yaml", "there is a pass `envelope` already"),
        ("passes/Mine.yaml", "`Mine` is no name for a pass"),
        ("passes/rules.envelope.yaml", "`rules.envelope` is no name for a pass"),
    ]
    known = find_known_passes(checked.loaded_project)
    assert known.passes["rules.envelope"].title.startswith("Wraps the type of each port")
    assert list(known.own_files) == ["Mine"]
