"""Templates of a project's own: what they can do, and what they cannot."""

from __future__ import annotations

import sys
from collections.abc import Callable
from pathlib import Path

import pytest

from archgen.emit import text
from archgen.emit.backend_manifests import Backend, find_backends
from archgen.emit.text.template_limits import TemplateLimits
from tests.property_sizes import try_some

RECORD = {"groups": {"a": {"title": "Sensing & <acting>"}, "b": {"title": "Cognition"}}, "name": "ramcip"}
QUICK = TemplateLimits(computing=2, waiting=60, memory=400_000_000, output=10_000, files=5)

Make = Callable[..., Backend]


@pytest.fixture
def make(tmp_path: Path) -> Make:
    """Make a project with one backend of its own, and find it."""

    def made(template: str, path: str = "out.md", more: str = "", name: str = "t.md.j2") -> Backend:
        folder = tmp_path / "backends" / "mine"
        (folder / "templates").mkdir(parents=True, exist_ok=True)
        (folder / "templates" / name).write_text(template)
        (folder / "backend.yaml").write_text(
            "id: mine\ntitle: Mine\nemitter: text\nview: record\nfiles:\n"
            f"  - template: {name}\n    path: '{path}'\n{more}"
        )
        found, diagnostics = find_backends(tmp_path)
        assert diagnostics == ()
        return found["mine"]

    return made


def files(backend: Backend) -> dict[str, str]:
    tree, diagnostics = text.render_backend(backend, {"record": RECORD}, QUICK)
    assert diagnostics == ()
    assert tree is not None
    return {path: data.decode() for path, data in tree.files.items()}


def fault(backend: Backend) -> str:
    tree, diagnostics = text.render_backend(backend, {"record": RECORD}, QUICK)
    assert tree is None
    (found,) = diagnostics
    assert found.rule == "backend-error"
    return f"{found.span.file}:{found.span.line}: {found.message}"


def test_a_template_gets_plain_data(make: Make) -> None:
    backend = make("{% for g in record.groups.values() %}\n- {{ g.title }}\n{% endfor %}\n")
    assert files(backend) == {"out.md": "- Sensing & <acting>\n- Cognition\n"}


def test_one_file_for_each_item(make: Make) -> None:
    backend = make("{{ key }}: {{ item.title }}", "g/{{ item.title }}.md", "    for_each: record.groups\n")
    assert files(backend) == {"g/sensing-acting.md": "a: Sensing & <acting>", "g/cognition.md": "b: Cognition"}


def test_only_some_items(make: Make) -> None:
    backend = make("x", "{{ key }}.md", "    for_each: record.groups\n    only: {title: Cognition}\n")
    assert list(files(backend)) == ["b.md"]


def test_a_backend_brings_an_escape_of_its_own(make: Make) -> None:
    template = "{{ record.groups.a.title|plantuml }} {{ '<&[1]'|plantuml }} {{ 7|plantuml }}"
    backend = make(template)
    manifest = backend.folder / "backend.yaml"
    manifest.write_text(
        manifest.read_text() + """escapes: {plantuml: {"<": "&lt;", "&": "&amp;", "[": "~[", "]": ""}}\n"""
    )
    backends, diagnostics = find_backends(backend.folder.parents[1])
    assert diagnostics == ()
    # What a replacement puts in place (`&lt;`) is not escaped again.
    assert files(backends["mine"]) == {"out.md": "Sensing &amp; &lt;acting> &lt;&amp;~[1 7"}


def test_an_escape_is_known_to_its_own_backend_only(make: Make) -> None:
    assert "No filter named 'plantuml'" in fault(make("{{ 'x'|plantuml }}"))


@pytest.mark.parametrize("name", ["t.html.j2", "t.xml.j2", "t.html", "t.svg.j2"])
def test_markup_is_escaped(make: Make, name: str) -> None:
    backend = make("{{ record.groups.a.title }}", "x.txt", name=name)
    assert files(backend) == {"x.txt": "Sensing &amp; &lt;acting&gt;"}


@pytest.mark.parametrize(
    ("path", "written"),
    [
        ("../../evil.md", "evil.md"),
        ("/etc/passwd", "etc/passwd"),
        ('{{ ".." }}/{{ ".." }}/x', "x"),
        ("con.md", "con_.md"),
        ("a\\..\\b.md", "a/b.md"),
        (".archgen-files", "archgen-files"),
    ],
)
def test_paths_stay_in_the_output_folder(make: Make, path: str, written: str) -> None:
    assert list(files(make("x", path))) == [written]


def test_paths_that_would_be_one_are_told_apart(make: Make) -> None:
    backend = make("{{ key }}", "same.md", "    for_each: record.groups\n")
    assert files(backend) == {"same.md": "a", "same-2.md": "b"}


@pytest.mark.parametrize(
    ("template", "said"),
    [
        ("one\n{{ record.nothing }}", ":2: the backend `mine` fails: 'dict object' has no attribute 'nothing'"),
        ("{{ nobody }}", ":1: the backend `mine` fails: 'nobody' is undefined"),
        ("one\ntwo {% if %}", ":2: the backend `mine` fails: this is no template: Expected an expression"),
        ("{{ 1 // 0 }}", ":1: the backend `mine` fails: ZeroDivisionError"),
        ("\n{% include 'other.j2' %}", ":2: the backend `mine` fails: there is no template `other.j2`"),
        ("{% include '../backend.yaml' %}", ":1: the backend `mine` fails: there is no template `../backend.yaml`"),
        ("{% include '/etc/passwd' %}", ":1: the backend `mine` fails: there is no template `/etc/passwd`"),
        ("{% macro m() %}{{ m() }}{% endmacro %}{{ m() }}", "call each other without end"),
        ("{% include 't.md.j2' %}", "call each other without end"),
        ("{% for i in range(900) %}aaaaaaaaaaaa{% endfor %}", "writes more than it may"),
        (
            "{{ '\\ud800' }}",
            ":1: the backend `mine` fails: it prints half a character (U+D800), which no file can hold",
        ),
        ("{{ record['\\ud800'] }}", "has no attribute"),
        # Places in memory are others in each run.
        (
            "\n{{ 'x'.translate }}",
            ":2: the backend `mine` fails: it prints what is no text: a built-in method translate",
        ),
        ("\n\n{{ [href]|groupby('__code__')|list }}", ":3: the backend `mine` fails: it prints what is no text"),
        ("{{ record.groups|map('upper') }}", "a generator object sync_do_map; a function is called with `()`"),
        ("{{ 'x'.upper ~ '' }}", "it prints what is no text: a built-in method upper of str object"),
        ("{{ '%s'|format(href) }}", "it prints what is no text"),
        ("{{ joiner() }}{{ range|upper }}", "it prints what is no text"),
    ],
)
def test_a_mistake_names_template_and_line(make: Make, template: str, said: str) -> None:
    found = fault(make(template))
    assert found.startswith("backends/mine/templates/t.md.j2:")
    assert said in found


@pytest.mark.parametrize(
    "template",
    [
        "{{ ''.__class__.__mro__[1].__subclasses__() }}",
        "{{ record.__class__ }}",
        "{{ record['__class__'] }}",
        "{{ record|attr('__class__') }}",
        "{{ self.__init__.__globals__ }}",
        "{{ cycler.__init__.__globals__.os }}",
        "{{ joiner.__init__.__globals__ }}",
        "{{ namespace.__init__.__globals__ }}",
        "{{ href.__globals__ }}",
        "{{ href.__closure__ }}",
        "{{ '{0.__class__}'.format(record) }}",
        "{{ '{a.__class__}'.format_map({'a': record}) }}",
        "{{ record|map(attribute='__class__')|join }}",
        "{{ record.update({'x': 1}) }}",
        "{{ record.groups.clear() }}",
        "{{ lipsum() }}",
        "{{ [1, 2]|random }}",
        "{{ ''|xmlattr|attr('__init__') }}",
    ],
)
def test_tricks_lead_nowhere(make: Make, template: str) -> None:
    assert "the backend `mine` fails" in fault(make(template))


@pytest.mark.parametrize(
    ("template", "said"),
    try_some(
        [
            (
                "{% for a in range(99999) %}{% for b in range(99999) %}{% set c = a * b %}{% endfor %}{% endfor %}",
                "may compute for 2 s",
            ),
            ("{{ 'x' * 10**9 }}", "more than 400 MB of memory"),
            ("{{ 'x'.ljust(10**9) }}", "more than 400 MB of memory"),
            (
                "{% set ns = namespace(s='x') %}{% for i in range(60) %}{% set ns.s = ns.s ~ ns.s %}{% endfor %}",
                "memory",
            ),
            ("{{ [0] * 10**9 }}", "more than 400 MB of memory"),
            ("{{ 10 ** (10 ** 9) }}", "may compute for 2 s"),
            ("{{ range(10**9)|list }}", "Range too big"),
        ],
        2,
    ),
)
def test_time_memory_and_output_are_bounded(make: Make, template: str, said: str) -> None:
    assert said in fault(make(template))


def test_the_number_of_files_is_bounded(make: Make) -> None:
    backend = make("x", "x.md", "    for_each: record.many\n")
    tree, (found,) = text.render_backend(backend, {"record": {"many": list(range(6))}}, QUICK)
    assert tree is None
    assert "more than 5 files" in found.message


@pytest.mark.skipif(sys.platform == "win32", reason="computing is not bound there")
def test_a_busy_machine_ends_no_template_that_computes_little() -> None:
    """With 20 others on its processor, a worker gets to the end of what it may compute before anybody ends it."""
    assert TemplateLimits().waiting > 20 * TemplateLimits().computing


def test_limits_grow_with_the_project_and_end() -> None:
    least = TemplateLimits()
    assert least.scale_to(2_500) == least
    large = least.scale_to(12_000)
    assert (large.computing, large.files, large.output, large.memory) == (96, 96_000, 307_200_000, 4_000_000_000)
    assert least.scale_to(25_000) == least.scale_to(10_000_000)
    assert least.scale_to(25_000).computing == 200


def test_for_each_must_be_there(make: Make) -> None:
    assert "no `record.nodes` in the data" in fault(make("x", "x.md", "    for_each: record.nodes\n"))


@pytest.mark.parametrize(
    "path", ["{{ 'a/' * 3000 }}x", "{{ 'a' * 99 }}/{{ ('b' * 99 ~ '/') * 10 }}x", "{{ 'a/' * 51 }}x"]
)
def test_a_path_that_no_file_system_takes_is_the_manifests_mistake(make: Make, path: str) -> None:
    found = fault(make("x", path.replace("'", '"')))
    assert found.startswith("backends/mine/backend.yaml:1: the backend `mine` fails: the path `")
    assert "it may have 50 and 1,000" in found


@pytest.mark.parametrize(
    "template",
    [
        "The fault at 0x40021000 <is> reported, <x at 0x7fff>",
        "{{ 'object at 0x1234, a function <f> at 0x12' }}",
        "{{ record.groups.items() }}{{ record.groups.values()|list }}",
        "{{ namespace(a=1) }}{{ none }}{{ 1.5 }}{{ true }}{{ [1, 'a'] }}",
        "{% macro m() %}a{% endmacro %}{{ m() }}{{ 'x'.upper() }}{{ record.groups|map('upper')|join(' ') }}",
    ],
)
def test_what_is_text_or_data_is_printed(make: Make, template: str) -> None:
    assert files(make(template))


@pytest.mark.parametrize("filters", ["", "|upper", "|markdown", "|code", "|replace('f', 'g')", "|escape"])
def test_text_of_the_project_may_quote_what_python_prints(make: Make, filters: str) -> None:
    quoted = "It logs <function f at 0x7f3A5c74c6>, and <a.B object at 0x7f0000000000> once"
    tree, diagnostics = text.render_backend(
        make(f"{{{{ record.note{filters} }}}}{{{{ record }}}}"),
        {"record": {"note": quoted}},
        QUICK,
    )
    assert diagnostics == ()
    assert tree is not None


def test_functions_stay_refused_beside_text_that_quotes_one(make: Make) -> None:
    data = {"record": {"note": "<function f at 0x7f3a5c74c6>"}}
    tree, (found,) = text.render_backend(make("{{ record.note }}{{ range ~ '' }}"), data, QUICK)
    assert tree is None
    assert "it prints what is no text: a function safe_range" in found.message


def test_a_mistake_in_a_path_is_the_manifests(make: Make) -> None:
    assert fault(make("x", "{{ nobody }}.md")).startswith("backends/mine/backend.yaml:1: the backend `mine` fails: ")


def test_a_template_that_is_a_link_out_is_not_read(make: Make, tmp_path: Path) -> None:
    backend = make("{% include 'secret.j2' %}")
    (tmp_path / "secret").write_text("secret")
    (backend.folder / "templates" / "secret.j2").symlink_to(tmp_path / "secret")
    assert "no template `secret.j2`" in fault(backend)


def test_a_template_that_is_no_text(make: Make) -> None:
    backend = make("x")
    (backend.folder / "templates" / "t.md.j2").write_bytes(b"\xff\xfe")
    assert "not UTF-8" in fault(backend)


def test_assets_are_copied_but_no_links(make: Make, tmp_path: Path) -> None:
    backend = make("x")
    (backend.folder / "assets").mkdir()
    (backend.folder / "assets" / "Logo.svg").write_text("<svg/>")
    (backend.folder / "assets" / "__pycache__").mkdir()
    (backend.folder / "assets" / "__pycache__" / "node.cpython-311.pyc").write_bytes(b"of this computer")
    assert files(backend) == {"out.md": "x", "assets/logo.svg": "<svg/>"}
    (backend.folder / "assets" / "key").symlink_to(tmp_path / "id_rsa")
    assert "`assets/key` is a link" in fault(backend)


def test_the_worker_sees_nothing_of_the_surroundings(
    make: Make, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "jinja2.py").write_text("raise SystemExit('taken over')")
    monkeypatch.setenv("PYTHONPATH", str(tmp_path))
    monkeypatch.chdir(tmp_path)
    assert files(make("fine")) == {"out.md": "fine"}
