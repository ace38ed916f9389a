"""What plug-ins may use is told: the page lists it as it is, and no name goes without a word."""

from __future__ import annotations

import importlib
import re
import runpy

import yaml

from archgen.installed_plugins import list_shipped_plugins
from tests.running import ROOT

TOOL = runpy.run_path(str(ROOT / "tools" / "make_plugin_page.py"))
TOLD: dict[str, list[str]] = yaml.safe_load((ROOT / "tests/plugin/told_names.yaml").read_text(encoding="utf-8"))
EXAMPLE = ROOT / "examples" / "plugin"
PAGE = (ROOT / "docs" / "plugins.md").read_text(encoding="utf-8")


def test_the_page_is_fresh() -> None:
    assert TOOL["renew_page"](PAGE) == PAGE, "run `make pages`"
    emptied = re.sub(r"(?s)(<!-- (shipped|subjects) -->\n).*?(<!-- end)", r"\1\3", PAGE)
    assert len(emptied) < len(PAGE)
    assert TOOL["renew_page"](emptied) == PAGE


def test_no_name_leaves_without_being_announced() -> None:
    names = {
        subject: list(importlib.import_module(f"archgen.plugin.{subject}").__all__)
        for subject in TOOL["list_subjects"]()
    }
    assert names == TOLD, (
        "write new names into told_names.yaml; one that leaves is announced in CHANGELOG.md one release before"
    )


def test_every_plug_in_names_its_page() -> None:
    for name, facts in list_shipped_plugins().items():
        assert facts["api"] == 1, name
        assert (ROOT / facts["page"]).is_file(), name


def test_the_page_shows_the_example_as_it_is() -> None:
    code = (EXAMPLE / "archgen_toy.py").read_text(encoding="utf-8")
    blocks = "\n\n\n".join(block.strip("\n") for block in re.findall(r"```python\n(.*?)```", PAGE, re.DOTALL))
    about, _, rest = code.partition("\n\n")
    assert about.startswith('"""')
    for line in rest.splitlines():
        assert line in blocks.splitlines(), f"docs/plugins.md does not show: {line}"
    assert f"```toml\n{(EXAMPLE / 'pyproject.toml').read_text(encoding='utf-8')}```" in PAGE
