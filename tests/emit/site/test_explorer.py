"""The explorer in Chromium, opened from the disk: what is on the map, keys and pointer, the address, and hostile titles."""

from __future__ import annotations

import re
from collections.abc import Iterator
from itertools import combinations, pairwise
from pathlib import Path
from typing import TYPE_CHECKING

import pytest

from archgen.emit.graphviz.label_places import count_crossings
from archgen.emit.graphviz.placed_scene import SceneLine
from archgen.model.architecture import Waypoint
from archgen.pipeline import check_project
from archgen.timing.chains.chain_bounds import find_paths_between, list_bounded_paths
from archgen.timing.chains.cost_network import CostNetwork
from archgen.views.timing.chain_status import round_duration
from archgen.views.timing.timing_lookup import analyse_with_chains
from tests.browser_pages import OpenPage, expect, judge_with_axe, watch_pages
from tests.browser_polling import wait_until
from tests.emit.site.conftest import write_bare_site
from tests.property_sizes import try_some
from tests.running import RAMCIP

if TYPE_CHECKING:
    from playwright.sync_api import Browser, Locator, Page

HOSTILE = '</script><img src=x onerror=document.title="taken"><script>document.title="taken"</script>'
POLICY = (
    "default-src 'none'; script-src 'self'; style-src 'self'; font-src 'self'; img-src 'self' data:; base-uri 'none'; "
    "form-action 'none'"
)
"""The least that a page is allowed."""


@pytest.fixture(scope="module")
def example(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Write the case study's site, without pictures."""
    return write_bare_site(RAMCIP, tmp_path_factory.mktemp("out") / "example")


@pytest.fixture
def visit(browser: Browser, example: Path) -> Iterator[OpenPage]:
    """Open the explorer; a request to anywhere else, an error or a message in the console is a failure."""
    with watch_pages(("file://", "data:")) as watch:

        def open_explorer(  # noqa: PLR0913 - what a reader's browser may be
            address: str = "",
            *,
            root: Path | None = None,
            path: str = "explorer.html",
            width: int = 1280,
            scheme: str = "light",
            scripts: bool = True,
            touch: bool = False,
        ) -> Page:
            context = browser.new_context(
                viewport={"width": width, "height": 800},
                color_scheme=scheme,  # type: ignore[arg-type]
                java_script_enabled=scripts,
                reduced_motion="reduce",
                has_touch=touch,
            )
            page = watch(context.new_page())
            page.goto(f"file://{root or example}/{path}{address}")
            if scripts and path.startswith("explorer"):
                expect(page.locator(".stage .box").first).to_be_attached()
            return page

        yield open_explorer


def box(page: Page, title: str) -> Locator:
    """Find a box by its title."""
    return page.locator(".stage .box").filter(has=page.locator("title", has_text=re.compile(rf"^{re.escape(title)}\n")))


def lit(page: Page) -> list[str]:
    """List the lit boxes by their titles."""
    return sorted(
        name.split("\n")[0] for name in page.locator(".stage .box.lit:not(:has(.open)) > title").all_text_contents()
    )


def address(page: Page) -> dict[str, str]:
    """Give what stands in the address."""
    return page.evaluate("Object.fromEntries(new URLSearchParams(location.hash.slice(1)))")  # type: ignore[no-any-return]


# --- what is on the map ---------------------------------------------------------------------------------------------


def test_the_map_opens_with_all_groups_closed_and_one_arrow_for_all_that_runs_between_two(visit: OpenPage) -> None:
    page = visit()
    assert page.locator(".stage .box").count() == 10
    assert page.locator(".map .arrow").count() == 39
    assert page.locator(".map .arrow.many").count() > 5


_SAMPLED_WAYS = """() => [...document.querySelectorAll("[data-arrow]")].map((node) => {
  const way = node.querySelector(".way"), length = way.getTotalLength();
  const ends = node.dataset.arrow.split(">").sort().join(" ");
  return [ends, Array.from({ length: 121 }, (_, at) => way.getPointAtLength((length * at) / 120)).map(({ x, y }) => [x, y])];
})"""


def test_closed_groups_stand_as_in_the_overview_and_few_lines_cross(visit: OpenPage) -> None:
    page = visit()
    # Both directions between two groups lie on one another: one line for each pair.
    ways = {ends: [tuple(point) for point in points] for ends, points in page.evaluate(_SAMPLED_WAYS)}
    assert len(ways) == 30
    straight_ways = [
        SceneLine(
            ends,
            ends,
            "",
            "",
            {},
            " ".join(f"{x},{y}" for one, other in pairwise(points) for x, y in (one, one, other)),
        )
        for ends, points in ways.items()
    ]
    assert sum(count_crossings(pair) > 0 for pair in combinations(straight_ways, 2)) <= 15
    columns = sorted(
        {
            round(float(x))
            for x in page.evaluate(
                "() => [...document.querySelectorAll('.box')].map((box) => box.transform.baseVal[0].matrix.e)"
            )
        }
    )
    assert len(columns) == 5


def test_a_pair_of_groups_opens_into_the_flows_of_both_directions(visit: OpenPage) -> None:
    page = visit()
    page.locator(".arrow.feedback .hit").first.click(force=True)
    expect(page.locator(".panel h2")).to_contain_text("↔")
    heads = page.locator(".panel .flows li div:nth-child(2) .name:last-of-type").all_inner_texts()
    assert len(set(heads)) > 1


def test_a_group_opens_in_place_and_back_closes_it(visit: OpenPage) -> None:
    page = visit()
    before = box(page, "Environment Model").bounding_box()
    box(page, "Human State").locator(".sign").click(force=True)
    expect(box(page, "Fall Detector")).to_be_visible()
    assert address(page)["open"] == "human_state"
    assert box(page, "Environment Model").bounding_box()["x"] == pytest.approx(before["x"], abs=1)  # type: ignore[index]
    page.go_back()
    expect(box(page, "Fall Detector")).to_have_count(0)
    page.go_forward()
    expect(box(page, "Fall Detector")).to_be_visible()


@pytest.mark.parametrize(
    ("level", "boxes", "first"),
    [("groups", 10, "Cognitive Reasoning"), ("nodes", 10, "Cognitive Reasoning"), ("hosts", 5, "Base Computer")],
)
def test_levels(visit: OpenPage, level: str, boxes: int, first: str) -> None:
    page = visit()
    page.get_by_role("button", name=level.capitalize(), exact=True).click()
    assert address(page)["level"] == level
    expect(page.locator(".stage .box")).to_have_count(boxes)
    assert box(page, first).is_visible()
    assert box(page, first).locator(".sign").count() == (0 if level == "groups" else 1)


def test_boxes_do_not_cover_one_another_when_all_is_open(visit: OpenPage) -> None:
    page = visit("#level=components&open=*")
    expect(page.locator(".stage .box")).to_have_count(71)
    overlapping = page.evaluate("""() => {
      const boxes = [...document.querySelectorAll(".stage .box")].filter(b => !b.querySelector(".open"))
        .map(b => b.querySelector(".shell").getBoundingClientRect());
      return boxes.flatMap((a, i) => boxes.slice(i + 1).filter(b =>
        a.left < b.right - 1 && b.left < a.right - 1 && a.top < b.bottom - 1 && b.top < a.bottom - 1)).length;
    }""")
    assert overlapping == 0


@pytest.mark.parametrize(
    ("hash_", "back", "forth"),
    [
        (
            "#level=components&open=robot_action_planner",
            "Base Controller → Hardware at the Boundary",
            "Robot State → Base Controller",
        ),
    ],
)
def test_what_runs_back_past_whole_columns_runs_below_all_boxes(
    visit: OpenPage, hash_: str, back: str, forth: str
) -> None:
    page = visit(hash_)
    below = page.evaluate(
        """() => {
          const bottom = Math.max(...[...document.querySelectorAll("g[data-box] .shell")].map((box) => box.getBoundingClientRect().bottom));
          return [...document.querySelectorAll("[data-arrow]")]
            .filter((arrow) => arrow.querySelector(".way").getBoundingClientRect().bottom > bottom)
            .map((arrow) => arrow.querySelector("title").textContent.split("\\n")[0]);
        }"""
    )
    assert back in below
    assert forth not in below


def test_the_panel_says_where_a_thing_is_written(visit: OpenPage) -> None:
    page = visit("#level=components&open=human_state&pick=human_state.fall_detector")
    expect(page.locator(".panel .written")).to_contain_text("Written in groups/human_state.yaml:")
    # An icon in each chip of a state.
    assert page.locator(".panel .chip").count() == page.locator(".panel .chip svg path[d^=M]").count() > 0


def test_a_merged_arrow_opens_into_its_flows(visit: OpenPage) -> None:
    page = visit()
    page.locator(".map .arrow.many").first.evaluate("a => a.dispatchEvent(new MouseEvent('click', {bubbles: true}))")
    flows = page.locator(".panel .flows li")
    assert flows.count() >= 4
    assert page.locator(".panel .crumb").inner_text() == f"{flows.count()} flows"
    assert ">" in address(page)["pick"]


# --- what is chosen, and the address ----------------------------------------------------------------------------------


def test_a_focus_lights_what_feeds_it_and_what_it_feeds(visit: OpenPage) -> None:
    page = visit("#level=components&open=human_state&sel=1%2Bfall_detector%2B1")
    assert lit(page) == ["Cognitive Reasoning", "Fall Detector", "Skeleton Tracking", "Speech Recognition"]
    assert page.locator(".map .arrow.lit.before").count() == 2
    assert page.locator(".map .arrow.lit.after").count() == 1
    assert sorted(page.locator(".map .label").all_text_contents()) == ["Distress call", "Fall alarm", "Skeletons"]
    assert page.locator("#selector-says").inner_text() == "4 of 61 lit"
    assert box(page, "Person Identification").evaluate("b => getComputedStyle(b).opacity") == "1"


def test_steps_before_and_after_are_counted_up_and_down(visit: OpenPage) -> None:
    page = visit("#level=components&open=human_state&sel=1%2Bfall_detector%2B1")
    page.get_by_role("button", name="More steps before").click()
    assert address(page)["sel"] == "2+fall_detector+1"
    page.get_by_role("button", name="Fewer steps after").click()
    assert address(page)["sel"] == "2+fall_detector"
    expect(page.get_by_role("button", name="Fewer steps after")).to_be_disabled()
    page.go_back()
    expect(page.locator("#selector")).to_have_value("2+fall_detector+1")


def test_positions_stay_on_focus_filter_and_theme(visit: OpenPage) -> None:
    page = visit("#level=components&open=human_state")
    places = "() => [...document.querySelectorAll('.stage .box')].map(b => [b.dataset.box, b.getAttribute('transform')]).sort()"
    before = page.evaluate(places)
    page.locator("#selector").fill("2+fall_detector+1")
    page.keyboard.press("Enter")
    page.get_by_role("button", name="Dark").click()
    assert page.evaluate(places) == before
    page.get_by_role("button", name="Filter").click()
    page.get_by_label("Partner", exact=True).select_option("certh")
    after = dict(page.evaluate(places))
    assert 0 < len(after) < len(before)
    assert all(dict(before)[name] == place for name, place in after.items())


def test_ways_from_a_to_b(visit: OpenPage) -> None:
    page = visit("#level=components&open=hardware")
    page.get_by_role("button", name="A → B: the ways").click()
    page.get_by_label("From", exact=True).fill("skeleton_tracking")
    page.get_by_label("To", exact=True).fill("situation_assessment")
    page.get_by_role("button", name="Show the ways").click()
    assert address(page)["sel"] == "skeleton_tracking..situation_assessment"
    # What the way of the panel passes is open, the rest stays as it was.
    assert address(page)["open"].split() == ["hardware", "human_state", "cognitive_reasoning"]
    assert {"Skeleton Tracking", "Situation Assessment"} == set(lit(page))


def test_of_all_ways_those_of_fewest_steps_are_lit_until_all_are_asked_for(visit: OpenPage) -> None:
    page = visit("#level=components&open=*&sel=skeleton_tracking..speed_separation_monitor")
    shortest = set(lit(page))
    assert len(shortest) < 6
    assert {"Skeleton Tracking", "Speed and Separation Monitor"} <= shortest
    page.get_by_role("button", name="All ways", exact=True).click()
    assert address(page)["ways"] == "all"
    assert len(lit(page)) > 40
    page.get_by_role("button", name="Only the shortest").click()
    assert set(lit(page)) == shortest
    # Another selector begins with its shortest ways.
    page.get_by_role("button", name="All ways", exact=True).click()
    page.locator("#selector").fill("skeleton_tracking..situation_assessment")
    page.keyboard.press("Enter")
    assert "ways" not in address(page)


@pytest.mark.parametrize(
    ("hash_", "words"),
    [
        ("#sel=fall_detectr", "nothing is called fall_detectr; did you mean fall_detector?"),
        ("#open=human_stat", "human_stat is not here; nearest: human_state."),
        ("#pick=nobody_at_all_here", "nobody_at_all_here is not here."),
        ("#level=rooms", "There is no level “rooms”."),
        ("#sel=a,b", ", is reserved; words are separated by blanks"),
    ],
)
def test_names_that_are_not_there_are_said_and_the_rest_is_obeyed(visit: OpenPage, hash_: str, words: str) -> None:
    page = visit(hash_ + "&colour=owner")
    assert page.locator(".notes").inner_text() == words
    assert page.locator(".legend .colours li").first.inner_text() == "TU München (16)"


def test_moving_is_kept_in_the_address_but_is_no_step_for_back(visit: OpenPage) -> None:
    page = visit()
    length = page.evaluate("history.length")
    page.mouse.move(600, 300)
    page.mouse.down()
    page.mouse.move(500, 240, steps=4)
    page.mouse.up()
    page.mouse.wheel(0, -240)
    wait_until(page, "location.hash.includes('at=')")
    assert page.evaluate("history.length") == length
    x, y, zoom = map(float, address(page)["at"].split(","))
    page.reload()
    expect(page.locator(".stage .box").first).to_be_attached()
    transform = page.locator(".map").evaluate("m => m.style.transform")
    assert [float(n) for n in re.findall(r"-?[\d.]+", transform)] == pytest.approx([x, y, zoom], abs=0.01)


def test_hover_lights_a_box_with_its_arrows_and_leaving_ends_that(visit: OpenPage) -> None:
    page = visit()
    box(page, "Human Model").hover()
    expect(page.locator(".map.dims")).to_have_count(1)
    assert "Human Model" in lit(page)
    assert "Hardware at the Boundary" not in lit(page)
    page.mouse.move(640, 130)
    expect(page.locator(".map.dims")).to_have_count(0)


def test_colours_have_words_in_the_legend(visit: OpenPage) -> None:
    page = visit("#open=*")
    for key, word in (("status", "planned"), ("period", "up to 100 ms"), ("finding", "a warning"), ("progress", "5 of 5 steps"),
                      ("requirement", "serves none"), ("host", "Vision Computer"), ("type", "others")):  # fmt: skip
        page.locator("#colour").select_option(key)
        assert word in page.locator(".legend .colours").inner_text(), key
        assert address(page)["colour"] == key


# --- keys -----------------------------------------------------------------------------------------------------------


def test_everything_by_keyboard(visit: OpenPage) -> None:
    page = visit()
    page.locator('.stage .box[tabindex="0"]').focus()
    page.keyboard.press("ArrowRight")
    page.keyboard.press("ArrowLeft")
    focused = page.evaluate("document.activeElement.querySelector('title').textContent.split('\\n')[0]")
    page.keyboard.press("o")
    assert address(page)["open"]
    assert page.evaluate("document.activeElement.querySelector('title').textContent.split('\\n')[0]") == focused
    page.keyboard.press("o")
    assert "open" not in address(page)
    page.keyboard.press("Enter")
    assert page.evaluate("document.activeElement.textContent") == focused
    page.keyboard.press("f")
    assert address(page)["sel"].startswith("1+")
    page.keyboard.press("]")
    page.keyboard.press("{")
    assert address(page)["sel"].startswith("2+")
    assert not address(page)["sel"].endswith("+1")
    page.keyboard.press("Escape")
    page.keyboard.press("Escape")
    assert {"sel", "pick"}.isdisjoint(address(page))
    before = page.locator(".map").evaluate("m => m.style.transform")
    page.keyboard.press("+")
    wait_until(page, f"document.querySelector('.map').style.transform !== '{before}'")
    page.keyboard.press("?")
    expect(page.get_by_role("dialog", name="Keys")).to_be_visible()
    page.keyboard.press("Escape")
    page.keyboard.press("s")
    page.keyboard.type("o")
    assert page.locator("#selector").input_value() == "o"


def test_a_list_has_all_that_the_map_has(visit: OpenPage) -> None:
    page = visit("#level=components&open=human_state&view=list")
    entries = page.locator(".as-list li > span:first-child > .name").all_inner_texts()
    assert len(entries) == page.locator(".stage .box").count() == 15
    assert (
        page.locator(".as-list").get_by_role("button", name="flow").count() == 2 * page.locator(".map .arrow").count()
    )
    page.get_by_role("button", name="Close Human State").click()
    assert "open" not in address(page)
    page.locator(".as-list").get_by_role("button", name="Human Model", exact=True).first.click()
    assert page.locator(".panel h2").inner_text() == "Human Model"


@pytest.mark.parametrize("scheme", try_some(["dark", "light"]))
@pytest.mark.parametrize(
    "hash_",
    ["", "#open=human_state&sel=2%2Bfall_detector%2B1&pick=human_state.fall_detector&colour=owner", "#view=list"],
)
def test_axe_finds_nothing(visit: OpenPage, scheme: str, hash_: str) -> None:
    assert judge_with_axe(visit(hash_, scheme=scheme)) == []


# --- ways in and out ------------------------------------------------------------------------------------------------


def test_pages_of_elements_lead_to_their_box(visit: OpenPage) -> None:
    page = visit(path="components/human_state.fall_detector.html")
    page.get_by_role("link", name="Show in explorer").click()
    expect(page.locator(".panel h2")).to_have_text("Fall Detector")
    expect(box(page, "Fall Detector")).to_be_visible()
    page.get_by_role("link", name="Open page").click()
    assert page.url.endswith("components/human_state.fall_detector.html")


def test_the_search_shows_what_it_found_on_the_map(visit: OpenPage) -> None:
    page = visit()
    page.keyboard.press("/")
    page.keyboard.type("fall detector")
    # Not busy yet is not busy, too: what it found is what tells.
    expect(page.locator("#find-list [role=option]").first).to_contain_text("Fall Detector")
    page.keyboard.press("Shift+Enter")
    expect(page.locator(".panel h2")).to_have_text("Fall Detector")
    expect(box(page, "Fall Detector")).to_be_visible()


def test_without_scripts_there_is_a_list_of_what_flows(visit: OpenPage) -> None:
    page = visit(scripts=False)
    assert page.get_by_role("link", name="the table of all connections").is_visible()
    assert page.locator("table tbody tr").count() > 40
    assert page.locator("nav#navigation").is_visible()
    # A script takes the list away, and gives it back on paper.
    page = visit()
    expect(page.locator(".explorer")).to_be_visible()
    expect(page.locator("main table")).to_have_count(0)
    page.emulate_media(media="print")
    expect(page.locator("main table").first).to_be_visible()
    page.emulate_media(media="screen")
    expect(page.locator("main table")).to_have_count(0)


def test_a_way_ends_in_how_long_it_takes(visit: OpenPage) -> None:
    """The same as `archgen timing` says of the shortest of the 23 ways."""
    architecture = check_project(RAMCIP).architecture
    timing = analyse_with_chains(architecture)
    network = CostNetwork.of_analysis(timing.analysis)
    ends = (Waypoint("node", "skeleton_tracker"), Waypoint("node", "separation_monitor"))
    path_set = find_paths_between(network, architecture, *ends)
    assert path_set
    shortest = min(list_bounded_paths(network, path_set, 100), key=lambda path: len(path.through))
    page = visit("#sel=skeleton_tracking..speed_separation_monitor")
    panel = page.get_by_role("complementary", name="Details")
    assert shortest.bound.value
    assert panel.locator(".sum").inner_text() == f"At most {round_duration(shortest.bound.value, '<')}"
    assert panel.locator(".steps a").all_inner_texts() == list(shortest.through)
    widths = panel.locator(".steps rect").evaluate_all(
        "all => all.map((each) => parseFloat(each.getAttribute('width')))"
    )
    parts = [each.value or 0 for term in shortest.terms for each in (term.link, term.sampling, term.response)]
    assert widths == pytest.approx([float(100 * each / shortest.bound.value) for each in parts if each])
    assert judge_with_axe(page) == []
    # What nobody knows is said, and has a place.
    page = visit("#level=nodes&sel=hand_eye_tracker..grasp_generator")
    panel = page.get_by_role("complementary", name="Details")
    assert panel.locator(".sum").inner_text().startswith("At least ")
    assert (
        panel.locator(".steps").get_by_text("nobody knows how long").count()
        == panel.locator(".steps .unknown").count()
        == 1
    )
    page.get_by_role("button", name="Close the details").click()
    expect(panel).to_be_hidden()
    assert address(page)["sel"] == "hand_eye_tracker..grasp_generator"


@pytest.mark.parametrize("form", ["SVG", "PNG"])
def test_a_view_is_saved_as_a_picture_that_stands_alone(visit: OpenPage, form: str, tmp_path: Path) -> None:
    page = visit("#open=human_state&sel=2%2Bfall_detector%2B1")
    page.get_by_role("button", name="Share").click()
    with page.expect_download() as download:
        page.get_by_role("button", name=f"Save as {form}").click()
    file = tmp_path / download.value.suggested_filename
    download.value.save_as(file)
    assert file.name == f"explorer-components-2_fall_detector_1.{form.lower()}"
    data = file.read_bytes()
    if form == "PNG":
        assert data.startswith(b"\x89PNG")
        assert len(data) > 20_000
        return
    text = data.decode()
    assert "Fall Detector" in text
    assert "rgb(138, 83, 0)" in text  # what feeds it
    assert "class=" not in text
    assert "var(" not in text


def test_a_strict_policy_refuses_nothing_of_it(visit: OpenPage, example: Path) -> None:
    text = (example / "explorer.html").read_text("utf-8")
    assert " style=" not in text
    assert "<style" not in text
    (example / "explorer_strict.html").write_text(
        text.replace("<head>", f'<head><meta http-equiv="Content-Security-Policy" content="{POLICY}">'), "utf-8"
    )
    page = visit("#open=human_state&pick=human_state.fall_detector", path="explorer_strict.html")
    page.get_by_role("button", name="Share").click()
    with page.expect_download():
        page.get_by_role("button", name="Save as PNG").click()


def test_pinch_zooms_on_a_phone(visit: OpenPage) -> None:
    page = visit(width=390, touch=True)
    scale = "() => Number(document.querySelector('.map').style.transform.match(/scale\\(([\\d.]+)/)[1])"
    before = page.evaluate(scale)
    page.evaluate("""() => {
      const stage = document.querySelector(".stage"), at = stage.getBoundingClientRect();
      stage.setPointerCapture = () => {};
      const send = (type, id, x) => stage.dispatchEvent(new PointerEvent(type, { pointerId: id, pointerType: "touch",
        clientX: at.left + x, clientY: at.top + 200, bubbles: true, button: 0 }));
      send("pointerdown", 1, 150); send("pointerdown", 2, 200);
      for (let step = 1; step < 12; step += 1) { send("pointermove", 1, 150 - step * 6); send("pointermove", 2, 200 + step * 6); }
      send("pointerup", 1, 90); send("pointerup", 2, 260);
    }""")
    wait_until(page, f"({scale})() > {before * 1.5}")


# --- hostile, large -------------------------------------------------------------------------------------------------


def test_hostile_titles_are_text(visit: OpenPage, tmp_path: Path) -> None:
    title = HOSTILE.replace("'", "''")
    long = "x" * 300
    (tmp_path / "robot.yaml").write_text(
        f"archgen: 1\nproject: {{id: r, title: '{title}'}}\npartners: {{p: {{title: '{title}'}}}}\n"
        f"hosts: {{h: {{title: '{title}'}}}}\n"
        f"groups:\n  a:\n    title: '{title}'\n    owner: p\n    components:\n"
        f"      c: {{title: '{title}', functionality: '{title}', outputs: {{o: '{title}'}}, tags: [t]}}\n"
        f"      d: {{title: '{long}', inputs: {{i: c.o}}}}\n"
        "  b:\n    title: \u202e\u202eevil\n    components:\n      e: {title: \U0001f916\U0001f9be, inputs: {i: a.c.o}}\n"
        "nodes: {n: {implements: [a.c], host: h}}\n",
        encoding="utf-8",
    )
    site = write_bare_site(tmp_path / "robot.yaml", tmp_path / "site")
    for hash_ in ("#open=a+b&pick=a.c", "#open=a+b&pick=a.d&sel=a.c%2B1", "#level=hosts&open=h", "#view=list&open=*", f"#sel={HOSTILE}&pick={HOSTILE}"):  # fmt: skip
        page = visit(hash_, root=site)
        assert page.locator("img").count() == 0
        assert "taken" not in page.title().split(" · ")[0]
        page.close()
    page = visit("#open=a", root=site)
    assert box(page, long).locator(".title.near").last.text_content().endswith("…")  # type: ignore[union-attr]


def test_levels_that_a_project_has_not_are_empty(visit: OpenPage, tmp_path: Path) -> None:
    (tmp_path / "robot.yaml").write_text(
        "archgen: 1\nproject: {id: r}\nnodes: {a: {publishes: {x: {topic: /x}}}, b: {subscribes: {x: {topic: /x}}}}\n",
        "utf-8",
    )
    site = write_bare_site(tmp_path / "robot.yaml", tmp_path / "site")
    page = visit(root=site)
    # Open: the frame around, and both.
    expect(page.locator(".stage .box")).to_have_count(3)
    expect(page.get_by_role("button", name="Hosts", exact=True)).to_be_hidden()
    page.evaluate("location.hash = '#level=hosts&open=*'")
    page.evaluate("location.hash = '#level=components'")
    expect(page.locator(".stage .box")).to_have_count(0)


@pytest.fixture(scope="module")
def large(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Write a site of 30 groups with 10 components each, wired at random but always alike."""
    folder = tmp_path_factory.mktemp("large")
    groups = []
    for group in range(30):
        groups.append(f"  g{group}:\n    title: Group {group}\n    components:")
        for number in range(10):
            sources = [f"g{(group * 7 + number * 3 + k) % 30}.c{(number + k) % 10}" for k in (1, 5, 11)]
            inputs = ", ".join(f"i{k}: {source}.o" for k, source in enumerate(sources))
            groups.append(f"      c{number}: {{inputs: {{{inputs}}}, outputs: {{o: T}}}}")
    (folder / "robot.yaml").write_text(
        "archgen: 1\nproject: {id: r, title: R}\ngroups:\n" + "\n".join(groups) + "\n", "utf-8"
    )
    return write_bare_site(folder / "robot.yaml", folder / "site")


def test_above_the_budget_groups_fold_and_what_is_chosen_keeps_its_neighbours(visit: OpenPage, large: Path) -> None:
    page = visit("#open=*&pick=g20.c5", root=large)
    assert page.locator(".stage .box").count() <= 150
    assert page.locator(".map .arrow").count() <= 300
    assert re.search(
        r"^\d+ groups folded, \d+ components, \d+ thin arrows left out\.", page.locator(".notes").inner_text()
    )
    arrows = page.locator(".map .arrow.lit").count()
    assert arrows >= 6 - 1  # three inputs, and three readers or so
    assert page.locator(".stage .box.picked, .stage .box.lit").count() > 4
    folded = page.locator(".notes button").first.inner_text()
    page.locator(".notes button").first.click()
    expect(page.locator(".stage .box:has(.open)").filter(has_text=folded)).to_have_count(1)
    page.get_by_role("button", name="Show all", exact=True).click()
    expect(page.locator(".stage .box")).to_have_count(330)
    expect(page.locator(".notes")).to_be_hidden()
