"""Plug-ins of others are found where installers write, and nowhere else: a project never brings code of its own."""

from __future__ import annotations

import os
import subprocess
import sys
import sysconfig
from pathlib import Path

import pytest

from archgen import installed_plugins
from archgen.installed_plugins import IMPORTERS, PluginRefusedError, list_all_entries, list_entries, load_facts
from tests.installed_packages import installed_in, write_package
from tests.running import ROOT

CODE = 'print("ran", __file__)\nPLUGIN = {"api": 1, "summary": "a toy", "endings": (".toy",), "reader": "archgen_toy:read_toy"}\n'
AS_MODULE, AS_CODE = ("-m", "archgen"), ("-c", "from archgen.__main__ import main; main()")
ENTRIES = {IMPORTERS: {"toy": "archgen_toy:PLUGIN"}}


def make_environment(folder: Path) -> Path:
    """Make a bare virtual environment that has this archgen and its libraries by a .pth file; return its site-packages."""
    subprocess.run([sys.executable, "-m", "venv", "--without-pip", folder], check=True)  # noqa: S603 - ourselves
    (site,) = (folder / "lib").glob("python*/site-packages")
    (site / "archgen_and_libraries.pth").write_text(f"{ROOT}\n{sysconfig.get_path('purelib')}\n", encoding="utf-8")
    return site


def run_here(python: Path, folder: Path, *words: str) -> subprocess.CompletedProcess[str]:
    """Run Python in a folder, without what this process has in its environment."""
    environment = {"PATH": os.environ["PATH"], "HOME": str(folder), "XDG_CACHE_HOME": str(folder / ".cache")}
    return subprocess.run([python, *words], cwd=folder, env=environment, capture_output=True, text=True, check=False)  # noqa: S603 - ourselves


@pytest.fixture(scope="module")
def environment(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("environment") / "venv"
    write_package(make_environment(folder), "archgen_toy", ENTRIES, CODE)
    return folder / "bin" / "python"


def test_a_package_is_found_where_installers_write(environment: Path, tmp_path: Path) -> None:
    done = run_here(environment, tmp_path, "-m", "archgen", "import", "--help")
    assert "  toy       a toy [archgen-toy 1.0]" in done.stdout
    assert "ran " in done.stdout
    done = run_here(environment, tmp_path, "-m", "archgen", "--no-plugins", "import", "--help")
    assert "toy" not in done.stdout
    assert "ran" not in done.stdout.split()
    # Whose group nobody asks for is not imported.
    assert "ran" not in run_here(environment, tmp_path, *AS_MODULE, "check", str(ROOT / "examples/first_robot")).stdout
    assert (
        "plug-in archgen-toy 1.0: importers toy\n"
        in run_here(environment, tmp_path, "-m", "archgen", "--version").stdout
    )


@pytest.mark.parametrize("words", [AS_MODULE, pytest.param(AS_CODE, marks=pytest.mark.slow)])
def test_a_project_brings_no_plug_in(words: tuple[str, ...], environment: Path, tmp_path: Path) -> None:
    write_package(tmp_path, "evil", {group: {"evil": "evil:PLUGIN"} for group in installed_plugins.GROUPS}, CODE)
    (tmp_path / "archgen.yaml").write_text("archgen: 1\n", encoding="utf-8")
    for verb in (("import", "--help"), ("check",), ("--version",)):
        done = run_here(environment, tmp_path, *words, *verb)
        assert "evil" not in done.stdout + done.stderr


@pytest.mark.parametrize(
    ("words", "name"),
    [
        (AS_MODULE, "archgen_toy.py"),
        (AS_MODULE, "archgen_toy/__init__.py"),
        (AS_MODULE, "jinja2.py"),
        (AS_MODULE, "json.py"),
        # Whoever calls it like this imports what archgen needs from this folder themselves, but no plug-in.
        (AS_CODE, "archgen_toy.py"),
    ],
)
def test_a_file_of_the_project_is_not_imported_in_place_of_another(
    words: tuple[str, ...], name: str, environment: Path, tmp_path: Path
) -> None:
    (tmp_path / name).parent.mkdir(exist_ok=True)
    (tmp_path / name).write_text('raise SystemExit("the project\'s own code ran")\n', encoding="utf-8")
    done = run_here(environment, tmp_path, *words, "import", "--help")
    assert "  toy       a toy [archgen-toy 1.0]" in done.stdout, done.stderr
    assert "ran" not in done.stderr


def test_a_module_from_elsewhere_is_refused(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    site, elsewhere = tmp_path / "site", tmp_path / "elsewhere"
    write_package(site, "archgen_toy", ENTRIES, CODE)
    (site / "archgen_toy.py").unlink()
    elsewhere.mkdir()
    (elsewhere / "archgen_toy.py").write_text(CODE, encoding="utf-8")
    with installed_in(site):
        (entry,) = list_entries(IMPORTERS)
        with pytest.raises(PluginRefusedError, match="there is no module `archgen_toy`; install the package again"):
            load_facts(entry)
        monkeypatch.syspath_prepend(elsewhere)
        with pytest.raises(PluginRefusedError, match="which lies in no folder of installed packages"):
            load_facts(entry)


def test_a_package_that_is_installed_to_be_edited_is_found_where_it_lies(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    site, source = tmp_path / "site", tmp_path / "source"
    write_package(site, "archgen_toy", ENTRIES, CODE)
    source.mkdir()
    (site / "archgen_toy.py").rename(source / "archgen_toy.py")
    monkeypatch.syspath_prepend(source)
    # By the record of the installer, as where a hook finds the module, or by a .pth file.
    record = site / "archgen_toy-1.0.dist-info" / "direct_url.json"
    record.write_text(f'{{"url": "file://{source}", "dir_info": {{"editable": true}}}}', encoding="utf-8")
    with installed_in(site):
        assert load_facts(list_entries(IMPORTERS)[0])["summary"] == "a toy"
    record.write_text(f'{{"url": "file://{source}", "dir_info": {{}}}}', encoding="utf-8")
    with installed_in(site), pytest.raises(PluginRefusedError, match="no folder of installed packages"):
        load_facts(list_entries(IMPORTERS)[0])
    record.unlink()
    (site / "toy.pth").write_text(f"# where it lies\nimport os\n{source}\n", encoding="utf-8")
    # What cannot be read is as if it were not there.
    (site / "folder.pth").mkdir()
    with installed_in(site):
        assert load_facts(list_entries(IMPORTERS)[0])["summary"] == "a toy"
    with installed_in(tmp_path / "gone"):
        assert list_entries(IMPORTERS) == ()


def test_entry_points_are_read_as_installers_write_them(tmp_path: Path) -> None:
    about = tmp_path / "archgen_toy-2.1.dist-info"
    about.mkdir()
    text = "[console_scripts]\ntoy = toy:main\n\n[archgen.importers]\n; none\n# none\ntoy=toy.reading:PLUGIN [extra]\n\n[archgen.later]\na = b:c\n"
    (about / "entry_points.txt").write_text(text, encoding="utf-8")
    (tmp_path / "other-1.dist-info").mkdir()
    with installed_in(tmp_path):
        found = [(each.group, each.name, each.target, each.origin) for each in list_all_entries()]
    assert found == [
        ("archgen.importers", "toy", "toy.reading:PLUGIN", "archgen-toy 2.1"),
        ("archgen.later", "a", "b:c", "archgen-toy 2.1"),
    ]


def test_a_refused_plug_in_is_a_sentence_and_status_2(environment: Path, tmp_path: Path) -> None:
    site = environment.parent.parent / "lib"
    (module,) = site.glob("python*/site-packages/archgen_toy.py")
    module.write_text('PLUGIN = {"api": 7}\n', encoding="utf-8")
    try:
        done = run_here(environment, tmp_path, "-m", "archgen", "import", "--help")
    finally:
        module.write_text(CODE, encoding="utf-8")
    assert done.returncode == 2
    assert done.stderr == (
        "Error: the plug-in `toy` (archgen.importers) of archgen-toy 1.0 is written for api 7 of archgen.plugin, and this "
        "archgen has 1: install a version of it that fits, or leave out plug-ins with `archgen --no-plugins`\n"
    )
