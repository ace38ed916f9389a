"""What a template may load and use, asked in this process; tests/emit/text/test_text.py asks the real one."""

from __future__ import annotations

from pathlib import Path

import pytest
from jinja2 import TemplateNotFound, UndefinedError
from jinja2.exceptions import SecurityError
from jinja2.sandbox import ImmutableSandboxedEnvironment

from archgen.emit.text.template_worker import TemplateBoundError, TemplateLoader, create_sandbox


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    templates = tmp_path / "templates"
    (templates / "deep").mkdir(parents=True)
    (templates / "a.md.j2").write_text("{{ x }}")
    (templates / "deep" / "b.html.j2").write_text("{{ x }}")
    (templates / "large.j2").write_text("x" * 1_000_001)
    (tmp_path / "secret").write_text("secret")
    (templates / "link").symlink_to("../secret")
    return templates


def _make_sandbox(folder: Path) -> ImmutableSandboxedEnvironment:
    return create_sandbox(folder, {})


@pytest.mark.parametrize("name", ["a.md.j2", "deep/b.html.j2"])
def test_templates_of_the_folder_are_loaded(folder: Path, name: str) -> None:
    assert TemplateLoader(folder).get_source(None, name)[0] == "{{ x }}"


@pytest.mark.parametrize("name", ["../secret", "link", "deep/../../secret", "/etc/passwd", "deep", "gone", "", "a\\b"])
def test_nothing_else_is(folder: Path, name: str) -> None:
    with pytest.raises(TemplateNotFound):
        TemplateLoader(folder).get_source(None, name)


def test_a_template_has_a_size(folder: Path) -> None:
    with pytest.raises(TemplateBoundError, match="more than 1000000 bytes"):
        TemplateLoader(folder).get_source(None, "large.j2")


@pytest.mark.parametrize(("name", "written"), [("a.md.j2", "<b>"), ("deep/b.html.j2", "&lt;b&gt;")])
def test_only_markup_is_escaped(folder: Path, name: str, written: str) -> None:
    assert _make_sandbox(folder).get_template(name).render(x="<b>") == written


@pytest.mark.parametrize(
    ("template", "error"),
    [
        ("{{ gone }}", UndefinedError),
        ("{{ lipsum() }}", UndefinedError),
        ("{{ ''.__class__.__mro__ }}", SecurityError),
        ("{{ [].append(1) }}", SecurityError),
    ],
)
def test_what_leads_into_python_or_to_chance_is_an_error(folder: Path, template: str, error: type[Exception]) -> None:
    with pytest.raises(error):
        _make_sandbox(folder).from_string(template).render()
