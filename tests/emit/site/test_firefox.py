"""The site in Firefox, from the disk: search, filters and explorer work as in Chromium, and no script of a page fails."""

from __future__ import annotations

from pathlib import Path

import pytest

from archgen.pipeline import check_project
from archgen.products import project_outputs
from archgen.products.output_options import OutputOptions
from tests.firefox_pages import run_firefox

PROJECT = """\
archgen: 1
project: {id: rover, title: Rover}
groups:
  sense:
    title: Sensing
    components:
      fall_detector: {title: Fall Detector, outputs: {fall: Fall}}
      eye: {title: Eye, outputs: {view: Picture}}
  act: {title: Acting, components: {brain: {title: Brain, inputs: {fall: sense.fall_detector.fall, view: sense.eye.view}}}}
  rest: {title: Rest, components: {PARTS}}
nodes: {eye_node: sense.eye, brain_node: act.brain}
""".replace("PARTS", ", ".join(f"part_{number}: Part {number}" for number in range(9)))
"""Tables have a filter from ten rows on."""
SHOWN_ROWS = "[...document.querySelectorAll('tbody tr')].filter(row => row.offsetParent).length"


@pytest.mark.slow
def test_search_filters_and_explorer_work_in_firefox(tmp_path: Path) -> None:
    (tmp_path / "archgen.yaml").write_text(PROJECT)
    site = tmp_path / "site"
    project_outputs.write_site(check_project(tmp_path), OutputOptions(revision="test"), site)
    with run_firefox(tmp_path / "profile") as firefox:
        firefox.open_page((site / "index.html").as_uri())
        firefox.type_text("body", "/")
        firefox.wait_until("document.querySelector('dialog[open] input') !== null")
        firefox.type_text("dialog[open] input", "fal detctor")
        firefox.wait_until("document.querySelector('dialog[open]').textContent.includes('Fall Detector')")
        firefox.type_text("dialog[open] input", "\ue007")  # the Enter key
        firefox.wait_until("location.pathname.endsWith('/components/sense.fall_detector.html')")

        firefox.open_page((site / "components.html").as_uri())
        firefox.wait_until("document.querySelector('main input[type=search]') !== null")
        firefox.type_text("main input[type=search]", "fall d")
        firefox.wait_until(f"{SHOWN_ROWS} === 1 && location.search.includes('fall')")
        firefox.open_page((site / "index.html").as_uri())
        firefox.send("WebDriver:Back")
        firefox.wait_until(
            f"{SHOWN_ROWS} === 1 && document.querySelector('main input[type=search]').value === 'fall d'"
        )

        firefox.open_page((site / "explorer.html").as_uri() + "#level=components")  # closed
        firefox.wait_until("[...document.querySelectorAll('button')].some(each => each.textContent === 'Open all')")
        firefox.ask("[...document.querySelectorAll('button')].find(each => each.textContent === 'Open all').click()")
        firefox.wait_until("location.hash.includes('open=') && document.body.textContent.includes('Fall Detector')")
        assert firefox.list_mistakes() == []
