"""`archgen import --merge` of a model that changed, into a project that people changed: nothing of theirs is lost."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.cli.conftest import Run
from tests.plugins.xmi.uml_models import write_model

CAMERA = """\
<packagedElement xmi:type="uml:Package" xmi:id="vision" name="Vision">
<packagedElement xmi:type="uml:Component" xmi:id="cam" name="Camera"><ownedAttribute xmi:type="uml:Port" xmi:id="img" name="image"/>
<ownedAttribute xmi:type="uml:Port" xmi:id="tmp" name="temperature"/></packagedElement></packagedElement>"""
VIEWER = """\
<packagedElement xmi:type="uml:Package" xmi:id="control" name="Control">
<packagedElement xmi:type="uml:Component" xmi:id="view" name="Viewer"><ownedAttribute xmi:type="uml:Port" xmi:id="pic" name="picture"/>
</packagedElement></packagedElement>
<packagedElement xmi:type="uml:Class" xmi:id="lens" name="Lens"><ownedAttribute xmi:type="uml:Property" xmi:id="zoom" name="zoom" \
visibility="public"><type href="x#Integer"/><defaultValue xmi:type="uml:LiteralInteger" xmi:id="z" value="3"/></ownedAttribute>
</packagedElement>
<packagedElement xmi:type="uml:Interface" xmi:id="i" name="Images"/>
<packagedElement xmi:type="uml:Usage" xmi:id="u" client="pic" supplier="i"/>
<packagedElement xmi:type="uml:Realization" xmi:id="r" client="img" supplier="i"/>"""
NODE = '<packagedElement xmi:type="uml:Node" xmi:id="pc" name="PC"/>'
MODEL = CAMERA + VIEWER + NODE


@pytest.fixture(autouse=True)
def _in_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)


def merge(run: Run, model: str) -> str:
    """Import a model, again if it is there, and return what is told."""
    Path("lab.xmi").write_text(write_model(model), encoding="utf-8")
    done = run("import", "lab.xmi", "-o", "robot", *(["--merge"] if Path("robot").exists() else []))
    assert done.status == 0, done.err + done.out
    return done.out


def read(name: str = "components") -> str:
    return Path("robot", f"{name}.yaml").read_text(encoding="utf-8")


def edit(old: str, new: str, name: str = "components") -> None:
    text = read(name)
    assert old in text
    Path("robot", f"{name}.yaml").write_text(text.replace(old, new, 1), encoding="utf-8")


def test_what_is_renamed_keeps_the_id_that_others_refer_to(run: Run) -> None:
    merge(run, MODEL)
    edit("      camera:\n", "      camera:\n        owner: us  # since May\n")
    edit("groups:\n", "partners: {us: {title: We}}\ngroups:\n")
    renamed = (
        MODEL.replace('"Camera"', '"Front eye"').replace('name="image"', 'name="Frames"').replace('"Lens"', '"Optics"')
    )
    out = merge(run, renamed.replace('"Vision"', '"Sight"').replace('"PC"', '"Brain"'))
    assert "kept" not in out
    text = read()
    assert "      camera:\n        owner: us  # since May\n" in text
    assert "        title: Front eye\n" in text
    assert "from: vision.camera.image" in text
    assert list_ids("component_types") == ["lens"]
    assert "title: Optics" in read("component_types")
    assert "pc:\n    title: Brain" in read("deployment")


def list_ids(name: str) -> list[str]:
    """Return the ids directly below the section of a slice."""
    lines = [line for line in read(name).splitlines() if line.startswith("  ") and not line.startswith("   ")]
    return [line.strip().rstrip(":") for line in lines]


def test_a_component_in_another_package_stays_where_it_is(run: Run) -> None:
    merge(run, MODEL)
    edit("      camera:\n", "      camera:\n        functionality: Looks.  # by hand\n")
    inner = CAMERA.partition("\n")[2].removesuffix("</packagedElement>")
    moved = VIEWER.replace('name="Control">\n', f'name="Control">\n{inner}', 1) + NODE
    out = merge(run, moved)
    assert "the model has vision.camera as control.camera by now: it stays where it is" in out
    text = read()
    assert "functionality: Looks.  # by hand" in text
    assert text.count("camera:\n") == 1
    assert "from: vision.camera.image" in text
    assert "as before" in merge(run, moved)


def test_where_another_component_stands_by_now_none_stays(run: Run) -> None:
    merge(run, MODEL)
    moved = MODEL.replace('xmi:id="cam" name="Camera"', 'xmi:id="new" name="Camera"').replace(
        'xmi:id="view" name="Viewer"', 'xmi:id="cam" name="Camera"'
    )
    merge(run, moved)
    text = read()
    assert text.count("camera:\n") == 2
    assert (text.count("id: cam\n"), text.count("id: new\n")) == (1, 1)


def test_what_is_deleted_goes_but_for_what_people_wrote(run: Run) -> None:
    merge(run, MODEL)
    edit("      viewer:\n", "      viewer:\n        owner: us  # since May\n")
    edit("groups:\n", "partners: {us: {title: We}}\ngroups:\n")
    port = '<ownedAttribute xmi:type="uml:Port" xmi:id="tmp" name="temperature"/>'
    zoom = VIEWER[
        VIEWER.index('<ownedAttribute xmi:type="uml:Property"') : VIEWER.index(
            "</ownedAttribute>\n</packagedElement>\n"
        )
        + 17
    ]
    out = merge(run, MODEL.replace(port, "").replace(zoom, "").replace(NODE, ""))
    assert "  removed: groups.vision.components.camera.outputs.temperature" in out
    assert "  removed: component_types.lens.parameters" in out
    assert "deployment.yaml: brought up to date\n  removed: hosts\n  nothing of it is in the model any more" in out
    assert "temperature:" not in read()
    assert "zoom:" not in read("component_types")
    gone = VIEWER[: VIEWER.index('<packagedElement xmi:type="uml:Class"')]
    usage = '<packagedElement xmi:type="uml:Usage" xmi:id="u" client="pic" supplier="i"/>'
    Path("lab.xmi").write_text(write_model(MODEL.replace(gone, "").replace(usage, "")), encoding="utf-8")
    done = run("import", "lab.xmi", "-o", "robot", "--merge")
    assert "not said any more, but people wrote there, which stays: groups.control (components.yaml:" in done.out
    assert "  control:\n    components:\n      viewer:\n        owner: us  # since May\n" in read()
    assert (done.status, "no file declares the component `control.viewer`" in done.err) == (1, True)


def test_what_people_added_to_a_list_stays(run: Run) -> None:
    merge(run, MODEL)
    edit("from: vision.camera.image", "from: [vision.camera.image, vision.camera.temperature]  # both")
    assert "components.yaml: as before" in merge(run, MODEL)
    assert "from: [vision.camera.image, vision.camera.temperature]  # both" in read()


def test_what_people_and_the_model_say_otherwise_is_told_once(run: Run) -> None:
    merge(run, MODEL)
    edit("value: 3", "value: 7  # measured", "component_types")
    assert "component_types.yaml: as before" in merge(run, MODEL)
    changed = MODEL.replace('value="3"', 'value="4"')
    told = "conflict: component_types.lens.parameters.zoom.value: it was `3` and is `4` now; `7` of the slice stays (component_types.yaml:"
    assert told in merge(run, changed)
    assert "value: 7  # measured" in read("component_types")
    assert "conflict" not in merge(run, changed)


def test_a_comment_above_the_line_that_tells_the_origin_is_no_obstacle(run: Run) -> None:
    merge(run, MODEL)
    for name in ("components", "component_types", "deployment"):
        edit("# From", "# yaml-language-server: $schema=x.json\n# Ours, with care.\n# From", name)
    assert "components.yaml: as before" in merge(run, MODEL)


def test_several_files_are_the_same_in_any_order(run: Run) -> None:
    Path("a.xmi").write_text(write_model(CAMERA), encoding="utf-8")
    Path("b.xmi").write_text(write_model(NODE), encoding="utf-8")
    assert run("import", "a.xmi", "b.xmi", "-o", "robot").status == 0
    done = run("import", "b.xmi", "a.xmi", "-o", "robot", "--merge")
    assert (done.status, "components.yaml: as before" in done.out) == (0, True)


def test_another_file_with_the_same_ids_is_refused(run: Run) -> None:
    merge(run, MODEL)
    before = read()
    Path("other.xmi").write_text(write_model(MODEL.replace("Camera", "Impostor")), encoding="utf-8")
    done = run("import", "other.xmi", "-o", "robot", "--merge")
    assert done.status == 2
    assert "does not come from this file: nothing was written" in done.err
    assert read() == before


def test_the_same_file_twice_changes_nothing(run: Run) -> None:
    merge(run, MODEL)
    before = {path.name: path.read_bytes() for path in Path("robot").glob("*.yaml")}
    assert "brought up to date" not in merge(run, MODEL)
    assert {path.name: path.read_bytes() for path in Path("robot").glob("*.yaml")} == before


def test_an_element_that_people_made_stays(run: Run) -> None:
    merge(run, MODEL)
    edit("  vision:\n", "  mine:\n    components:\n      helper: {functionality: Helps.}\n  vision:\n")
    out = merge(run, MODEL.replace(NODE, NODE + NODE.replace("PC", "Second").replace('"pc"', '"pc2"')))
    assert "  added: hosts.second" in out
    assert "helper: {functionality: Helps.}" in read()
    assert list_ids("deployment") == ["pc", "second"]
