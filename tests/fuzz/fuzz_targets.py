"""What the fuzzer feeds: each reader of archgen, and each verb that writes, with where its inputs begin and how they are changed.

A target takes the parts of an input and a folder of its own. It raises nothing but what its reader declares, and
AssertionError where what was read does not hold what the reader promises.
"""

from __future__ import annotations

import io
import random
import re
import shutil
import zlib
from collections.abc import Callable, Sequence
from contextlib import chdir, redirect_stderr, redirect_stdout, suppress
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import click

from archgen.diagnostics.diagnostic import Diagnostic, Severity
from tests import hostile
from tests.fuzz import fuzz_seeds as seeds


@dataclass(frozen=True)
class Target:
    """A reader: what its inputs are made of, what it does with one, and what it begins with."""

    name: str
    kinds: tuple[str, ...]
    """The kinds of the parts: `xml`, `yaml`, `python`, `zip`, `lines`, or `choice`, a number."""
    read: Callable[[Sequence[bytes], Path], None]
    list_seeds: Callable[[], Sequence[bytes]]
    share: int = 4
    """Of the time of a run, beside those of the others."""
    writes: bool = True
    """Whether it needs an empty folder for each input."""


# --- readers alone


def _read_yaml(parts: Sequence[bytes], folder: Path) -> None:
    from archgen.syntax.yaml_parser import parse_yaml
    from archgen.syntax.yaml_tree import node_to_data
    from archgen.syntax.yaml_writer import write_yaml

    del folder
    with suppress(UnicodeDecodeError):
        document, _ = parse_yaml("a.yaml", parts[0].decode())
        if document is not None:
            data = node_to_data(document.root)
            assert isinstance(data, dict)
            write_yaml(data)


def _read_quantities(parts: Sequence[bytes], folder: Path) -> None:
    from archgen.model.quantity import UNIT_FACTORS, parse_quantity, parse_share
    from archgen.schema.quantity_wording import describe_wrong_quantity

    del folder
    for line in parts[0].decode("utf-8", "replace").split("\n"):
        parse_share(line)
        for dimension in UNIT_FACTORS:
            if parse_quantity(line, dimension) is None:
                describe_wrong_quantity("x", line, dimension, {"patternErrorMessage": ""})


@cache
def _load_robot() -> Any:  # noqa: ANN401 - a checked project; imported when it is asked for
    from archgen.pipeline import check_project

    return check_project(seeds.ROOT / "examples/cleaning_robot")


def _read_selector(parts: Sequence[bytes], folder: Path) -> None:
    from archgen.model.selector_evaluation import evaluate_selector

    del folder
    for line in parts[0].decode("utf-8", "replace").split("\n")[:20]:
        evaluate_selector(line, _load_robot().architecture)


def _read_interfaces(parts: Sequence[bytes], folder: Path) -> None:
    from archgen.syntax.interface_definitions import parse_interface_definition

    del folder
    for kind in ("msg", "srv", "action"):
        for ros1 in (False, True):
            parse_interface_definition(
                parts[0].decode("utf-8", "replace"), f"p/{kind}/A", f"p/{kind}/A.{kind}", ros1=ros1
            )


def _read_tables(name: str) -> Callable[[Sequence[bytes], Path], None]:
    def read(parts: Sequence[bytes], folder: Path) -> None:
        from archgen.plugins.tables.table_cells import parse_heading_map
        from archgen.plugins.tables.table_import import read_tables
        from archgen.syntax.yaml_writer import write_yaml

        tables = read_tables([(name, parts[-1])], "jazzy", parse_heading_map(()))
        if tables.data and _is_drawn(parts):
            _demand_no_errors(write_yaml({"archgen": 1, "project": {"id": "x"}, **tables.data}), folder)

    return read


def _read_recording(parts: Sequence[bytes], folder: Path) -> None:
    from archgen.importers.foreign_import import RecordingRefusedError
    from archgen.plugins.recordings.recording_import import read_recordings

    (folder / "recorded").write_bytes(parts[0])
    with suppress(RecordingRefusedError):
        read_recordings([folder / "recorded"], _load_recorded_names())


@cache
def _load_recorded_names() -> Any:  # noqa: ANN401 - as `_load_robot`
    import tempfile

    from tests.plugins.recordings.recorded import make_names

    with tempfile.TemporaryDirectory() as folder:
        return make_names(Path(folder))


# --- importers: what is taken makes a project without errors


def _read_import(form: str, *names: str, distro: str = "jazzy") -> Callable[[Sequence[bytes], Path], None]:
    """Return what writes the parts of an input into files of these names, and imports the first."""

    def read(parts: Sequence[bytes], folder: Path) -> None:
        from archgen.edit.earlier_import import ImportOrigin
        from archgen.edit.imported_slices import ImportRefusedError, plan_import
        from archgen.importers.foreign_import import ForeignFileError
        from archgen.importers.import_formats import list_import_formats

        for name, part in zip(names, parts, strict=True):
            (folder / name).parent.mkdir(parents=True, exist_ok=True)
            (folder / name).write_bytes(part)
        reader: Any = list_import_formats()[form].load_reader()
        try:
            imported = reader([folder / names[0]])
        except ForeignFileError:
            return
        if imported.slices and _is_drawn(parts):
            (folder / "new").mkdir()
            (folder / "new/archgen.yaml").write_text(f"archgen: 1\nproject: {{id: x}}\nros: {{distro: {distro}}}\n")
            with suppress(ImportRefusedError):
                plan = plan_import(imported, ImportOrigin(form, (names[0],), ()), folder / "new", merge=False)
                _refuse_errors(plan.errors)

    return read


MODEL_RULES = frozenset(
    {
        *("circular-fields", "circular-types", "conflicting-message", "incompatible-qos", "invalid-ros-name"),
        *("too-large", "topic-type-conflict", "type-mismatch", "unknown-message", "wrong-parameter"),
    }
)
"""Errors that an importer hands on: they are in what the model says, and are told as that."""


def _is_drawn(parts: Sequence[bytes]) -> bool:
    """Whether what is read is judged, too, which takes longer: one input in so many, by its bytes."""
    return not zlib.crc32(parts[-1]) % JUDGED_ONE_IN


JUDGED_ONE_IN = 8


def _demand_no_errors(text: str, folder: Path) -> None:
    from archgen.pipeline import check_project

    (folder / "archgen.yaml").write_text(text, encoding="utf-8")
    _refuse_errors(
        [finding for finding in check_project(folder / "archgen.yaml").findings if finding.severity is Severity.ERROR]
    )


def _refuse_errors(errors: Sequence[Diagnostic]) -> None:
    wrong = [error for error in errors if error.rule not in MODEL_RULES]
    if wrong:
        msg = "\n".join(f"{error.rule}: {error.message}" for error in wrong)
        raise AssertionError(msg)


def _read_reqif(name: str) -> Callable[[Sequence[bytes], Path], None]:
    def read(parts: Sequence[bytes], folder: Path) -> None:
        from archgen.importers.foreign_import import ForeignFileError
        from archgen.plugins.reqif.reqif_import import read_requirements
        from archgen.syntax.yaml_writer import write_yaml

        (folder / name).write_bytes(parts[0])
        try:
            taken = read_requirements(folder / name, ())
        except ForeignFileError:
            return
        if taken.requirements and _is_drawn(parts):
            sections = {"use_cases": taken.use_cases, "requirements": taken.requirements}
            _demand_no_errors(
                write_yaml(
                    {"archgen": 1, "project": {"id": "x"}, **{key: value for key, value in sections.items() if value}}
                ),
                folder,
            )

    return read


# --- verbs

OUTPUT = "out"
_READING_WORDS = (
    "check", "check --format json", "check --format sarif", "check --format junit", "check --format github", "check --strict", "stats", "stats --format json",
    "timing", "timing --format json", "list", "list --of connections --format csv", "list --of nodes --format json", "list --of parameters", "list --of start_up",
    "start", "start --format json", "owners", "owners --format codeowners", "show a", "show x", "simulate --seconds 1 --seeds 1", "timing --sensitivity c", "timing --budget c",
    "timing --propose", "timing --why x", "diff one.yaml", "diff one.yaml --format json", "fmt --check", "fmt --diff", "check --select x", "check --variant v",
    "todo --partner {partner}", "todo --partner {partner} --format json", "todo --partner {other} --format markdown", "impact --partner {partner}", "impact --partner {other} --format json",
    "impact --component {element} --until 2027-01-01", "list --of requirements", "list --of interfaces --format csv", "list --of promises --format json", "show {element}", "timing --why {element}",
)  # fmt: skip
_WRITING_WORDS = (
    "pack --keep-going -o out/p.yaml", "pack --resolved --keep-going -o out/r.yaml", "transform flatten --keep-going -o out/t.yaml", "transform resolve_instances remove_generics --keep-going -o out/t.yaml", "transform envelope --keep-going -o out/t.yaml", "transform normalise_connections connect_ports connect_types --keep-going -o out/t.yaml",
    "transform --list", "schema -o out/s.json", "export mermaid --keep-going", "export d2 --keep-going", "export plantuml --keep-going", "export structurizr --keep-going", "export graphml --keep-going",
    "generate xmi --keep-going -o out/w", "export xmi --keep-going", "export reqif --keep-going", "generate ros2_python --keep-going -o out/w", "generate ros2_cpp --keep-going -o out/w", "generate ros_interfaces --keep-going -o out/w",
    "generate ros2_launch --keep-going -o out/w", "generate ros1_python --keep-going -o out/w", "generate ros1_launch --keep-going -o out/w", "generate start --keep-going -o out/w",
    "generate python_simulation --keep-going -o out/w", "generate orocos --keep-going -o out/w", "generate java --keep-going -o out/w", "generate openrtm --keep-going -o out/w",
    "generate player --keep-going -o out/w", "generate orca --keep-going -o out/w", "generate aadl --keep-going -o out/w", "generate nodl --keep-going -o out/w",
    "interfaces --between {partner} {other} --keep-going -o out/i.md", "interfaces --between {other} {partner} --keep-going -o out/i.json", "owners --format codeowners --keep-going -o out/C",
)  # fmt: skip
_DOCUMENT_WORDS = (
    "report --keep-going --no-history -o out/r.docx", "report --keep-going --no-history --format xlsx -o out/r.xlsx", "slides --keep-going -o out/s.pptx", "diagram --keep-going -o out/d", "site --keep-going -o out/site",
    "build --keep-going --backend csv --backend wiki -o out/b", "review -o out/v", "diff one.yaml --format html -o out/d.html", "diff one.yaml --format markdown",
)  # fmt: skip
_ADDING_WORDS = (
    "new component {a} --group {b}", "new component {a}.{b} --role filter --functionality {c}", "new group {a} --owner {b}", "new node {a} --implements {b} --host {c}", "new type {a} --is {b} --generic {c}",
    "new instance {a}.{b} {c}", "new variant {a} --without {b}", "new partner {a} --reviewers {b}", "new component {a}", "new component {a}.{b}.{c}",
)  # fmt: skip
_EDITING_WORDS = (
    "rename {a} {b}", "rename {a} {b} --keep-topics --keep-message --keep-title", "rename {a} {b} --kind {c} --keep-chapters", "move {a} {b}", "move {a} --file {b}.yaml",
    "move {a} {b} --file sub/{c}.yaml", "split archgen.yaml", "split archgen.yaml --by component", "split archgen.yaml --by group", "split archgen.yaml --by section", "check --fix", "fmt",
)  # fmt: skip


def run_verb(words: Sequence[str], folder: Path) -> str:
    """Run a verb in a folder, and return what it printed. Errors that it declares are none of the fuzzer's."""
    from archgen.cli import main
    from archgen.installed_plugins import PluginRefusedError

    out, err = (io.TextIOWrapper(io.BytesIO(), encoding="utf-8", errors="replace") for _ in range(2))
    with (
        chdir(folder),
        redirect_stdout(out),
        redirect_stderr(err),
        suppress(click.ClickException, click.Abort, SystemExit, PluginRefusedError),
    ):
        main.main(args=list(words), prog_name="archgen", standalone_mode=False)
    said = "".join(_end_stream(stream) for stream in (out, err))
    controls = hostile.controls(said.replace("\r\n", "\n"))
    if controls:
        msg = f"control characters are printed: {controls}"
        raise AssertionError(msg)
    return said


def _end_stream(stream: io.TextIOWrapper) -> str:
    stream.flush()
    written: io.BytesIO = stream.detach()  # type: ignore[assignment]
    return written.getvalue().decode("utf-8", "replace")


def _run_words(choices: Sequence[str]) -> Callable[[Sequence[bytes], Path], None]:
    def read(parts: Sequence[bytes], folder: Path) -> None:
        number = int(parts[0]) if parts[0].isdigit() else 0
        (folder / "one.yaml").write_bytes(b"archgen: 1\nproject: {id: x}\n")
        (folder / "two.yaml").write_bytes(parts[1])
        words = _fill_names(choices[number % len(choices)], parts[1]).split()
        # `diff` takes two versions, and verbs that name a backend, a pass or an element have `-C`.
        takes_option = words[0] in {"transform", "export", "generate", "interfaces", "list", "show"}
        words += ["two.yaml"] if words[0] == "diff" else ["-C", "two.yaml"] if takes_option else ["two.yaml"]
        run_verb(words, folder)

    return read


def _fill_names(words: str, text: bytes) -> str:
    """Put names of a project into the words of a verb: two of its partners, and a key of it that its bytes choose."""
    _, _, below = text.partition(b"partners:")
    partners = [name.decode() for name in re.findall(rb"([a-z]\w*):", below)[:2]] + ["p", "q"]
    keys = [name.decode() for name in re.findall(rb"([a-z]\w*):", text)] or ["x"]
    return words.format(partner=partners[0], other=partners[1], element=keys[zlib.crc32(text) % len(keys)])


def _list_named_projects() -> list[bytes]:
    """Return three names of a project and the project, for verbs that rename and move."""
    made = []
    for number, text in enumerate(seeds.list_projects()):
        draw = random.Random(number)  # noqa: S311 - no secrets
        names = [name for name in re.findall(rb"([a-z]\w*):", text) if len(name) > 1] or [b"x"]
        lines = b"\n".join(
            (
                draw.choice(names),
                draw.choice((b"fresh", draw.choice(names))),
                draw.choice((b"component", b"node", b"later")),
            )
        )
        made += [seeds.join_parts(b"%d" % draw.randrange(len(_EDITING_WORDS)), lines, text) for _ in range(3)]
    return made


def _run_editing(parts: Sequence[bytes], folder: Path) -> None:
    """Edit a project; what may be taken back is, to the last byte, and what is laid out stays so."""
    number = int(parts[0]) if parts[0].isdigit() else 0
    names = [*(line[:60] for line in parts[1].decode("utf-8", "replace").replace("\0", "").split("\n")), "a", "b", "c"]
    (folder / "archgen.yaml").write_bytes(parts[2])
    before = _read_slices(folder)
    words = _EDITING_WORDS[number % len(_EDITING_WORDS)].split()
    run_verb([word.format(a=names[0], b=names[1], c=names[2]) for word in words], folder)
    after = _read_slices(folder)
    if words[0] == "fmt":
        run_verb(["fmt"], folder)
        assert _read_slices(folder) == after, "laid out twice is another text"
    elif words[0] != "check" and after != before:
        run_verb(["undo"], folder)
        assert _read_slices(folder) == before, "not all is taken back"


def _read_slices(folder: Path) -> dict[str, bytes]:
    return {str(file.relative_to(folder)): file.read_bytes() for file in folder.rglob("*.yaml") if file.is_file()}


def _run_conformance(parts: Sequence[bytes], folder: Path) -> None:
    (folder / "archgen.yaml").write_bytes(parts[0])
    (folder / "graph.txt").write_bytes(parts[1])
    run_verb(
        ["conform", "--against", "graph.txt", *_of_choice(parts[1], ([], ["--format", "json"], ["--strict"]))], folder
    )


def _of_choice(data: bytes, choices: Sequence[list[str]]) -> list[str]:
    return choices[zlib.crc32(data) % len(choices)]


def _list_conformance_seeds() -> list[bytes]:
    import tempfile

    from tests.conformance import rovers

    with tempfile.TemporaryDirectory() as folder:
        rover = rovers.check_rover(Path(folder))
        graph = rovers.print_graph(rover.architecture).encode()
    return [
        seeds.join_parts(rovers.ROVER.encode(), graph),
        *(seeds.join_parts(text, graph) for text in seeds.list_projects()[:100]),
    ]


def _run_beside(parts: Sequence[bytes], folder: Path) -> None:
    """Read what stands beside a project: what was signed, what is known, what was imported or written before."""
    number = int(parts[0]) if parts[0].isdigit() else 0
    name, words = _BESIDE[number % len(_BESIDE)]
    (folder / "archgen.yaml").write_bytes(parts[2])
    (folder / name).parent.mkdir(parents=True, exist_ok=True)
    (folder / name).write_bytes(parts[1])
    run_verb(words.split(), folder)


_BESIDE = (
    ("agreements/a-b.yaml", "check"),
    ("archgen-baseline.yaml", "check"),
    ("archgen-baseline.yaml", "check --update-baseline"),
    ("ws/.archgen/ros2_python.json", "generate ros2_python --keep-going -o ws"),
    ("archgen-out/.archgen-files", "build --keep-going --only csv"),
    ("run.csv", "timing --measured run.csv"),
    ("run.csv", "timing --measured run.csv --adopt measured.yaml"),
)


def _run_open_branches(parts: Sequence[bytes], folder: Path) -> None:
    """Merge two branches of a repository that begin at one version."""
    from tests.repositories import git

    lines: list[bytes] = []
    for branch, text, start in (("main", parts[0], ""), ("other", parts[1], "main"), ("main", parts[2], "main")):
        lines += [
            f"commit refs/heads/{branch}\ncommitter A <a@b> 1700000000 +0000\ndata 1\nx\n".encode(),
            f"from refs/heads/{start}\n".encode() if start and branch != start else b"",
            b"M 644 inline archgen.yaml\ndata %d\n%s\n" % (len(text), text),
        ]
    git(folder, "init", "-q", "-b", "main", ".")
    git(folder, "fast-import", "--quiet", stdin=b"".join(lines))
    run_verb(["merge-check", "main", "other", *_of_choice(parts[1], ([], ["--format", "json"]))], folder)


def _run_own_code(parts: Sequence[bytes], folder: Path) -> None:
    """Make a workspace, put code into its own files, and make it again of another version."""
    for text in parts[1:]:
        (folder / "archgen.yaml").write_bytes(text)
        run_verb(["generate", "ros2_python", "--keep-going", "-o", "ws"], folder)
        for contract in sorted((folder / "ws").rglob("*_contract.py")):
            own = contract.with_name(contract.name.replace("_contract", ""))
            if own.is_file() and parts[0]:
                own.write_bytes(parts[0])
    run_verb(["generate", "ros2_python", "--keep-going", "--check", "-o", "ws"], folder)


_OWN_CODE = """\
from std_msgs.msg import Bool

class Own:
    def __init__(self, node): self.node = node
    def receive_scan(self, message: "LaserScan") -> None:
        self.node.publish_stop(Bool(data=self.node.get_parameter("rate").value > 1))
    def run(self): getattr(self.node, "publish_x")(self)
"""


# --- what editors ask


def _ask_server(parts: Sequence[bytes], folder: Path) -> None:
    """Open a file, type another text, and ask everything at some places of it."""
    from archgen.lsp.answers import ANSWERS, RefusedRequestError

    (folder / "archgen.yaml").write_bytes(parts[1])
    server, types = _make_server()
    uri = (folder / "archgen.yaml").as_uri()
    text = parts[2].decode("utf-8", "replace")
    found = server.open_projects.open_file(uri, text)
    if found is None:
        return
    project, file = found
    project.set_text(file, text)
    project.check_quickly()
    project.take_whole_check(project.start_whole_check()())
    lines = text.split("\n")
    draw = random.Random(parts[0])  # noqa: S311 - no secrets
    for method in sorted(ANSWERS):
        if not method.startswith("textDocument/") or "did" in method:
            continue
        line = draw.randrange(len(lines) + 1)
        place = types.Position(line, draw.randrange(len(lines[line]) + 2) if line < len(lines) else 0)
        asked = SimpleNamespace(
            text_document=types.TextDocumentIdentifier(uri),
            position=place,
            range=types.Range(types.Position(0, 0), place),
            context=SimpleNamespace(include_declaration=True, only=None),
            new_name=parts[0].decode("utf-8", "replace")[:40],
        )
        with suppress(RefusedRequestError):
            ANSWERS[method](server, asked)


def _make_server() -> Any:  # noqa: ANN401 - the server, and the types of what it is asked
    from lsprotocol import types
    from pygls.workspace import Workspace

    from archgen.lsp.open_projects import OpenProjects

    server = _start_server()
    server.open_projects = OpenProjects()
    server.protocol._workspace = Workspace(None)  # noqa: SLF001 - what a client's greeting makes of it
    server.protocol.client_capabilities = types.ClientCapabilities()
    server.window_show_message = lambda _: None
    return server, types


@cache
def _start_server() -> Any:  # noqa: ANN401 - as above
    from archgen.lsp.language_server import create_server

    return create_server("0")


def _run_adding(parts: Sequence[bytes], folder: Path) -> None:
    number = int(parts[0]) if parts[0].isdigit() else 0
    names = [*(line[:60] for line in parts[1].decode("utf-8", "replace").replace("\0", "").split("\n")), "a", "b", "c"]
    (folder / "archgen.yaml").write_bytes(parts[2])
    words = _ADDING_WORDS[number % len(_ADDING_WORDS)].split()
    run_verb([word.format(a=names[0], b=names[1], c=names[2]) for word in words], folder)


def _import_twice(name: str) -> Callable[[Sequence[bytes], Path], None]:
    """Return what imports one version of a file into a project, and then brings it up to date by another one."""

    def read(parts: Sequence[bytes], folder: Path) -> None:
        (folder / "archgen.yaml").write_text("archgen: 1\nproject: {id: x}\nsources: ['*.yaml', '!*.launch.yaml']\n")
        for part, options in zip(parts, ([], ["--merge"] if "reqif" not in name else []), strict=True):
            (folder / name).write_bytes(part)
            run_verb(["import", name, *options], folder)
        run_verb(["check"], folder)

    return read


def _start_from_table(parts: Sequence[bytes], folder: Path) -> None:
    (folder / "t.csv").write_bytes(parts[0])
    run_verb(["init", "new", "--from", "t.csv", "--ci", "none", "--yes"], folder)


def _run_merge(parts: Sequence[bytes], folder: Path) -> None:
    for name, part in zip(("base", "ours", "theirs"), parts, strict=True):
        (folder / name).write_bytes(part)
    run_verb(["merge-driver", "base", "ours", "theirs", "x.yaml"], folder)


def _read_pass(parts: Sequence[bytes], folder: Path) -> None:
    (folder / "passes").mkdir()
    (folder / "passes/own.yaml").write_bytes(parts[0])
    (folder / "archgen.yaml").write_bytes(parts[1])
    run_verb(["transform", "own", "--keep-going", "-o", "out/t.yaml"], folder)


def _read_packed(parts: Sequence[bytes], folder: Path) -> None:
    (folder / "packed.yaml").write_bytes(parts[0])
    run_verb(["pack", "packed.yaml", "--keep-going", "-o", "again.yaml"], folder)
    run_verb(
        ["diff", "packed.yaml", "again.yaml"] if (folder / "again.yaml").exists() else ["stats", "packed.yaml"], folder
    )


def _read_template(parts: Sequence[bytes], folder: Path) -> None:
    """Render a template as its process does: in a sandbox, on the view of the robot."""
    from jinja2 import TemplateError

    from archgen.emit.text.template_worker import TemplateBoundError, create_sandbox

    (folder / "a.j2").write_bytes(parts[0])
    sandbox = create_sandbox(folder, {})
    # What a template raises is told as its own mistake; what must not happen is that it leaves the sandbox or the process.
    with suppress(
        TemplateError,
        TemplateBoundError,
        ArithmeticError,
        LookupError,
        TypeError,
        ValueError,
        AttributeError,
        RecursionError,
        MemoryError,
    ):
        str(sandbox.get_template("a.j2").render(_template_values()))


@cache
def _template_values() -> dict[str, Any]:
    return {
        "structure": {
            "project": {"id": "x", "title": "X"},
            "groups": [{"id": "a", "components": [{"id": "b", "inputs": []}]}],
            "edges": [],
        }
    }


def _read_backend(parts: Sequence[bytes], folder: Path) -> None:
    (folder / "backends/own/templates").mkdir(parents=True)
    (folder / "backends/own/backend.yaml").write_bytes(parts[0])
    (folder / "backends/own/templates/a.j2").write_bytes(parts[1])
    (folder / "archgen.yaml").write_bytes(
        b"archgen: 1\nproject: {id: x}\nbackends: [own]\ngroups: {a: {components: {b: {outputs: {o: T}}, c: {inputs: {i: b.o}}}}}\n"
    )
    run_verb(["list", "--of", "backends"], folder)
    run_verb(["export", "own", "--keep-going"], folder)


@cache
def _make_repository() -> Path:
    import tempfile

    from tests import repositories

    folder = repositories.repository(
        Path(tempfile.mkdtemp(prefix="fuzz-repository-")) / "top",
        {"archgen.yaml": "archgen: 1\nproject: {id: x}\n", "a/b.yaml": "types: {T: }\n"},
    )
    repositories.commit(folder, {"archgen.yaml": "archgen: 1\nproject: {id: x, title: Y}\n"})
    return folder


def _read_repository(parts: Sequence[bytes], folder: Path) -> None:
    """Put bytes in the place of an object, a reference or the configuration of a repository, and ask for its versions."""
    shutil.copytree(_make_repository(), folder / "top", symlinks=True)
    files = sorted(path for path in (folder / "top/.git").rglob("*") if path.is_file() and "hooks" not in path.parts)
    file = files[(int(parts[0]) if parts[0].isdigit() else 0) % len(files)]
    file.chmod(0o644)
    data = parts[1]
    if "objects" in file.parts:
        kind, _, content = data.partition(b"\n")
        data = zlib.compress(kind.replace(b"#", str(len(content)).encode()) + b"\0" + content) if kind else content
    file.write_bytes(data)
    run_verb(
        (["diff", "HEAD^"], ["stats", "--history"], ["diff", "HEAD"], ["check"])[zlib.crc32(parts[1]) % 4],
        folder / "top",
    )


def _list_repository_seeds() -> list[bytes]:
    kinds = [
        b"blob #\narchgen: 1\n",
        b"tree #\n100644 archgen.yaml\0" + b"a" * 20,
        b"tree #\n40000 a\0" + b"b" * 20 + b"120000 c\0" + b"c" * 20,
        b"commit #\ntree " + b"a" * 40 + b"\nauthor A <a> 1 +0000\n\nx\n",
        b"tag #\nobject " + b"a" * 40,
        b"\nx",
        b"[core]\nbare = true\n",
        b"ref: refs/heads/x\n",
    ]
    return seeds.cross_parts(seeds.number_choices(60), kinds)


# --- all of them


def _is_launch_xml(text: str) -> bool:
    return "<launch" in text or text.lstrip().startswith(("<node", "<group", "<include"))


def _wrap_launch(texts: Sequence[bytes]) -> list[bytes]:
    return [text if b"<launch" in text else b"<launch>" + text + b"</launch>" for text in texts]


_ROS = "tests/plugins/ros"
_LAUNCH_SEEDS = (f"{_ROS}/launch", f"{_ROS}/test_launch_verb.py", "tests/plugins/ros_code")
_SLOW_LAUNCH = ("range(1000)", "x.append(x)")
"""What is there to meet the bounds of work: while ways are counted it takes seconds each time."""
_NODE_LINES = b"\n".join(
    (b"/talker", b"  Subscribers:", b"    /a: std_msgs/msg/String", b"  Publishers:", b"    /b: std_msgs/msg/String")
)


def list_targets() -> list[Target]:
    """Return all targets."""
    choose, files = seeds.choose_texts, seeds.list_files
    projects = seeds.list_projects
    return [
        Target("yaml", ("yaml",), _read_yaml, lambda: [*projects(), *choose(lambda text: ":" in text and len(text) < 2000, "tests/syntax")], writes=False),
        Target("quantities", ("lines",), _read_quantities, lambda: [text.encode("utf-8", "replace") for text in seeds.list_code_texts("tests/model", "tests/schema") if 0 < len(text) < 30], writes=False),
        Target("selectors", ("lines",), _read_selector, seeds.list_words_of_selectors, writes=False),
        Target("interfaces", ("lines",), _read_interfaces, lambda: [*files("**/*.msg", "**/*.srv", "**/*.action"), *choose(lambda text: "\n" in text, "tests/syntax")], writes=False),
        Target("csv", ("lines",), _read_tables("t.csv"), lambda: [*files("tests/plugins/tables/partner_tables/*.csv"), *choose(lambda text: "\n" in text and ("," in text or ";" in text), "tests/plugins/tables")]),
        Target("office", ("zip",), _read_office, lambda: list(seeds.list_workbooks())),
        Target("recordings", ("lines",), _read_recording, _list_recordings),
        Target("launch_xml", ("xml",), _read_import("launch", "a.launch.xml"), lambda: _wrap_launch(choose(_is_launch_xml, *_LAUNCH_SEEDS)), 8),
        Target("launch_ros1", ("xml",), _read_import("launch", "a.launch", distro="noetic"), lambda: _wrap_launch(choose(_is_launch_xml, *_LAUNCH_SEEDS)), 6),
        Target("launch_yaml", ("yaml",), _read_import("launch", "a.launch.yaml"), lambda: [*choose(lambda text: "launch:" in text or text.startswith("- "), *_LAUNCH_SEEDS), *seeds.list_launch_yaml(_wrap_launch(choose(_is_launch_xml, *_LAUNCH_SEEDS)))], 8),
        Target("launch_python", ("python",), _read_import("launch", "a.launch.py"), lambda: choose(lambda text: "LaunchDescription" in text and not any(mark in text for mark in _SLOW_LAUNCH), *_LAUNCH_SEEDS), 10),
        Target("package", ("xml", "python", "lines", "yaml"), _read_import("package", "p/package.xml", "p/setup.py", "p/CMakeLists.txt", "p/config/a.yaml"), _list_packages, 8),
        Target("xmi", ("xml",), _read_import("xmi", "a.xmi"), lambda: choose(lambda text: "xmi:" in text and text.lstrip().startswith("<"), "tests/plugins/xmi") + _list_models(), 8),
        Target("xmi_archive", ("zip",), _read_import("xmi", "a.mdzip"), lambda: seeds.list_archives("com.nomagic.magicdraw.uml_model.model", _list_models()), 2),
        Target("aadl", ("lines",), _read_import("aadl", "a.aadl"), lambda: [*files("tests/**/*.aadl"), *choose(lambda text: "system" in text and "end" in text, "tests/plugins/aadl")], 8),
        Target("reqif", ("xml",), _read_reqif("a.reqif"), lambda: [(seeds.ROOT / "tests/plugins/reqif/doors.reqif").read_bytes(), *choose(lambda text: "<REQ-IF" in text, "tests/plugins/reqif")], 6),
        Target("reqif_archive", ("zip",), _read_reqif("a.reqifz"), lambda: seeds.list_archives("a.reqif", [(seeds.ROOT / "tests/plugins/reqif/doors.reqif").read_bytes()]), 2),
        Target("nodl", ("yaml",), _read_import("nodl", "a.nodl.yaml"), lambda: choose(lambda text: ":" in text and "\n" in text, f"{_ROS}/nodl")),
        Target("nodl_xml", ("xml",), _read_import("nodl", "a.nodl.xml"), lambda: choose(lambda text: text.lstrip().startswith("<"), f"{_ROS}/nodl")),
        Target("orca", ("lines",), _read_import("orca", "a.def"), lambda: choose(lambda text: "{" in text or "=" in text, "tests/plugins/orca")),
        Target("ros1_dump", ("lines",), _read_import("ros1", "d.txt", distro="noetic"), lambda: choose(lambda text: "\n" in text, f"{_ROS}/running_graph")),
        Target("ros2_dump", ("lines",), _read_import("ros2", "d.txt"), lambda: [_NODE_LINES, *choose(lambda text: "\n" in text, f"{_ROS}/running_graph")]),
        Target("again_launch", ("xml", "xml"), _import_twice("a.launch.xml"), lambda: _double(_wrap_launch(choose(_is_launch_xml, *_LAUNCH_SEEDS)))),
        Target("again_aadl", ("lines", "lines"), _import_twice("a.aadl"), lambda: _double([*files("tests/**/*.aadl"), *choose(lambda text: "system" in text and "end" in text, "tests/plugins/aadl")])),
        Target("again_xmi", ("xml", "xml"), _import_twice("a.xmi"), lambda: _double(_list_models())),
        Target("again_reqif", ("xml", "xml"), _import_twice("a.reqif"), lambda: _double([(seeds.ROOT / "tests/plugins/reqif/doors.reqif").read_bytes()])),
        Target("started", ("lines",), _start_from_table, lambda: [*files("tests/plugins/tables/partner_tables/*.csv"), *choose(lambda text: "\n" in text and ("," in text or ";" in text), "tests/plugins/tables")]),
        Target("slices", ("choice", "yaml"), _run_words(_READING_WORDS), lambda: seeds.cross_parts(seeds.number_choices(len(_READING_WORDS)), projects(), limit=2000), 40),
        Target("written", ("choice", "yaml"), _run_words(_WRITING_WORDS), lambda: seeds.cross_parts(seeds.number_choices(len(_WRITING_WORDS)), projects()), 20),
        Target("documents", ("choice", "yaml"), _run_words(_DOCUMENT_WORDS), lambda: seeds.cross_parts(seeds.number_choices(len(_DOCUMENT_WORDS)), projects()), 8),
        Target("packed", ("yaml",), _read_packed, projects, 8),
        Target("added", ("choice", "lines", "yaml"), _run_adding, lambda: seeds.cross_parts(seeds.number_choices(len(_ADDING_WORDS)), [b"a\nb\nc", b"g\nx\ny", b"sensing\ncamera\nz"], projects()), 6),
        Target("edited", ("choice", "lines", "yaml"), _run_editing, _list_named_projects, 12),
        Target("conformed", ("yaml", "lines"), _run_conformance, _list_conformance_seeds, 6),
        Target("beside", ("choice", "yaml", "yaml"), _run_beside, lambda: seeds.cross_parts(seeds.number_choices(len(_BESIDE)), [*choose(lambda text: "signed:" in text or "findings:" in text, "tests/products", "tests/findings", "tests/cli"), b"{}"], projects()), 4),
        Target("branches", ("yaml", "yaml", "yaml"), _run_open_branches, lambda: [seeds.join_parts(text, text, text) for text in projects()], 6),
        Target("own_code", ("python", "yaml", "yaml"), _run_own_code, lambda: [seeds.join_parts(_OWN_CODE.encode(), text, text) for text in projects() if b"nodes:" in text], 6),
        Target("editor", ("lines", "yaml", "yaml"), _ask_server, lambda: [seeds.join_parts(b"fresh", text, text) for text in projects()], 10),
        Target("merged", ("yaml", "yaml", "yaml"), _run_merge, lambda: [seeds.join_parts(text, text, text) for text in projects()], 6),
        Target("passes", ("yaml", "yaml"), _read_pass, lambda: seeds.cross_parts([*files("passes/*.yaml"), *choose(lambda text: "find:" in text, "tests/passes/patterns")], projects()), 6),
        Target("templates", ("lines",), _read_template, lambda: files("backends/**/*.j2", "archgen/plugins/*/backends/**/*.j2"), 2),
        Target("backends", ("yaml", "lines"), _read_backend, lambda: seeds.cross_parts(files("backends/*/backend.yaml", "archgen/plugins/*/backends/*/backend.yaml"), [b"{{ structure.project.id }}"]), 2),
        Target("repository", ("choice", "lines"), _read_repository, _list_repository_seeds, 4),
    ]  # fmt: skip


def _double(texts: Sequence[bytes]) -> list[bytes]:
    return [seeds.join_parts(text, text) for text in texts]


def _read_office(parts: Sequence[bytes], folder: Path) -> None:
    _read_tables("t.docx" if b"word/" in parts[0] else "t.xlsx")(parts, folder)


def _list_models() -> list[bytes]:
    return [
        text
        for text in seeds.choose_texts(lambda text: "<uml:" in text or "<packagedElement" in text, "tests/plugins/xmi")
        if len(text) < seeds.MAX_SEED_BYTES
    ] + seeds.list_files("tests/golden/neighbours/xmi", "examples/headlamp/headlamp.xmi")


def _list_packages() -> list[bytes]:
    marks = (("<package",), ("setup(",), ("add_executable", "install(", "project("), ("ros__parameters", "type:"))
    texts = seeds.list_code_texts(f"{_ROS}/ros_package")
    lists = [[text.encode() for text in texts if any(mark in text for mark in each)] for each in marks]
    return seeds.cross_parts(*(each or [b""] for each in lists))


def _list_recordings() -> list[bytes]:
    texts = seeds.choose_texts(
        lambda text: "\n" in text or "," in text, "tests/plugins/recordings", "tests/cli/test_timing.py"
    )
    from tests.plugins.recordings import recorded

    trace = (
        recorded.node("1")
        + recorded.timer("1", "0x1", 50)
        + recorded.subscription("2", "0x2", "/scan")
        + recorded.node("2")
        + recorded.run("1", "0x1", 1, 5)
        + recorded.run("2", "0x2", 6, 9)
    )
    bag = "rosbag2_bagfile_information:\n  version: 5\n  duration: {nanoseconds: 1000000000}\n  message_count: 10\n  topics_with_message_count:\n    - topic_metadata: {name: /scan, type: a_msgs/msg/T}\n      message_count: 10\n"
    return [
        trace.encode(),
        bag.encode(),
        *(b"\x89MCAP0\r\n", b"SQLite format 3\0", b"\xc1\x1f\xfc\xc1"),
        b"average rate: 10.0\n\tmin: 0.1s max: 0.2s std dev: 0.01s window: 10\n",
        *texts,
    ]
