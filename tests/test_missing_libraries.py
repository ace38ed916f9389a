"""A machine without the libraries that draw: everything else is made, and says so."""

from __future__ import annotations

import re
from pathlib import Path
from urllib.parse import unquote, urldefrag

import pytest

from tests import readable
from tests.running import RAMCIP, ROOT, archgen, contents

LIBRARY = "libX11.so.6: cannot open shared object file: No such file or directory"


@pytest.fixture(scope="module")
def poor(tmp_path_factory: pytest.TempPathFactory) -> dict[str, str]:
    """Give an environment in which pygraphviz is there but cannot be imported, and nothing was drawn before."""
    place = tmp_path_factory.mktemp("poor")
    (place / "pygraphviz").mkdir()
    (place / "pygraphviz" / "__init__.py").write_text(f"raise ImportError({LIBRARY!r})\n")
    return {"PYTHONPATH": str(place), "XDG_CACHE_HOME": str(place / "cache")}


@pytest.fixture(scope="module")
def built(poor: dict[str, str], tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, str, str]:
    """Build the case study there; give the folder, and both streams."""
    place = tmp_path_factory.mktemp("built")
    done = archgen("build", RAMCIP, "-o", "out", cwd=place, env=poor)
    return place / "out", done.stdout.decode(), done.stderr.decode()


@pytest.mark.slow
def test_build_names_the_package_once_and_makes_the_rest(built: tuple[Path, str, str]) -> None:
    folder, out, err = built
    hint = "On Debian and Ubuntu: apt-get install libglib2.0-0 libx11-6 libxext6 libxrender1 libexpat1"
    said = [line for line in err.splitlines() if "picture" in line and "docs/" not in line]
    assert said == [
        f"warning: pictures need the system package libx11-6 (or what it is called here): {LIBRARY}. {hint}"
    ]
    wrote = ["wrote out/report.docx", "wrote out/site/index.html", "wrote out/packed.yaml"]
    assert out.splitlines()[:-1] == wrote
    assert sorted(path.name for path in folder.iterdir()) == ["packed.yaml", "report.docx", "site"]


@pytest.mark.slow
def test_the_report_says_what_is_missing(built: tuple[Path, str, str]) -> None:
    lines = readable.document(built[0] / "report.docx").splitlines()
    captions = [at for at, line in enumerate(lines) if re.match(r"\[Caption\] Figure \d+: ", line)]
    said = "[NoteBox] This picture could not be drawn. "
    own_pictures = {
        "The robot from the side, with its main devices",
        "Floor plan of the test flat: hallway, living room, kitchen, bathroom and bedroom, with the robot's charging place",
    }
    assert len(captions) == len(own_pictures) + 3, "the overview, the frames and the hosts are drawn"
    drawn = [at for at in captions if not lines[at - 1].startswith(said)]
    assert {lines[at].partition(": ")[2] for at in drawn} <= own_pictures, (
        "pictures of chapters are files, and are there"
    )
    assert len(drawn) == len(own_pictures)


def test_the_site_says_what_is_missing_and_links_to_nothing_that_is_not_there(built: tuple[Path, str, str]) -> None:
    site = built[0] / "site"
    files = contents(site)
    assert b"This picture could not be drawn." in files["groups/environment_state.html"]
    assert not [path for path in files if path.startswith("figures/")]
    for path, data in files.items():
        if path.endswith(".html"):
            addresses = re.findall(r'(?:href|src)="([^"#:]+)(?:#[^"]*)?"', data.decode())
            assert [a for a in addresses if not (site / path).parent.joinpath(unquote(urldefrag(a)[0])).exists()] == []


def test_diagram_fails(poor: dict[str, str], tmp_path: Path) -> None:
    done = archgen("diagram", ROOT / "examples" / "first_robot", "-o", "out", cwd=tmp_path, env=poor, status=2)
    assert done.stderr.decode().splitlines()[1:] == ["Error: no picture could be drawn, nothing was written"]
    assert not (tmp_path / "out").exists()
