"""A package that cannot be called so costs that package, not all others."""

from __future__ import annotations

from pathlib import Path

import pytest

from archgen.pipeline import check_project
from archgen.plugins.ros_code.node_programs import drop_unusable, make_view
from archgen.views.generation.generation_context import GeneratedView, GenerationContext


def make(folder: Path, node: str, language: str = "python") -> GeneratedView:
    (folder / "archgen.yaml").write_text(
        "archgen: 1\nproject: {id: lab}\nros: {distro: jazzy}\ngroups: {g: {components: {a: {functionality: A.}, b: {functionality: B.}}}}\n"
        f"nodes:\n  b: {{implements: b, package: fine, language: {language}}}\n  a: {{implements: a, language: {language}, {node}}}\n",
        encoding="utf-8",
    )
    return make_view(GenerationContext(check_project(folder).architecture, options={"language": language}))


@pytest.mark.parametrize(
    ("node", "message"),
    [
        (
            "package: ../../etc",
            "the package `../../etc` is left out: packages have names of letters (a to z), digits and `_`",
        ),
        ("package: 'a b'", "the package `a b` is left out: packages have names of letters (a to z), digits and `_`"),
        (
            "package: my-nodes",
            "the package `my-nodes` is left out: packages have names of letters (a to z), digits and `_`",
        ),
        ("package: class", "the package `class` is left out: its name is a word of Python"),
        (f"package: {'x' * 101}", f"the package `{'x' * 101}` is left out: its name has more than 100 letters"),
        ("package: Fine", "the package `Fine` is left out: on many systems it is the folder of `fine`"),
        ("executable: ../run", "the program `../run` of `a` is left out: no file is called so that ROS runs"),
        ("executable: '-x'", "the program `-x` of `a` is left out: no file is called so that ROS runs"),
    ],
)
def test_the_others_are_made(node: str, message: str, tmp_path: Path) -> None:
    view = make(tmp_path, node)
    assert [each["node_name"] for each in view.data["programs"]] == ["b"]
    (finding,) = view.findings
    assert (finding.message, finding.span.line) == (message, 7)


def test_words_of_the_language_are_what_counts(tmp_path: Path) -> None:
    assert make(tmp_path, "package: namespace").findings == ()
    (finding,) = make(tmp_path, "package: namespace", "cpp").findings
    assert finding.message == "the package `namespace` is left out: its name is a word of C++"


def test_each_package_is_told_once(tmp_path: Path) -> None:
    make(tmp_path, "package: 'no one'")
    nodes = check_project(tmp_path).architecture.nodes
    programs = {("no one", "x"): [nodes["a"]], ("no one", "y"): [nodes["b"]], ("fine", "z"): [nodes["b"]]}
    usable, findings = drop_unusable(programs, "python")
    assert list(usable) == [("fine", "z")]
    assert [each.element for each in findings] == ["a"]


def test_why_nothing_is_made_is_told_as_a_note(tmp_path: Path) -> None:
    made = make(tmp_path, "package: other")
    assert len(made.data["programs"]) == 2
    architecture = check_project(tmp_path).architecture
    (finding,) = make_view(GenerationContext(architecture, options={"language": "cpp"})).findings
    assert (finding.message, finding.effective_severity.value) == (
        "no node is in C++: all that are to be generated are in Python",
        "note",
    )
    assert finding.help == "write `language: cpp` at nodes that are to be in C++"
    file = tmp_path / "archgen.yaml"
    text = file.read_text(encoding="utf-8").replace("language: python", "status: existing")
    file.write_text(text, encoding="utf-8")
    (finding,) = make_view(GenerationContext(check_project(tmp_path).architecture)).findings
    assert finding.message == "there is no node to generate: each exists already, or is no node of ROS"
    # Who asks for a part knows that it may be empty.
    part = GenerationContext(check_project(tmp_path).architecture, components=frozenset())
    assert make_view(part).findings == ()
