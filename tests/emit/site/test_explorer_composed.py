"""Composed components in the explorer, in Chromium: opened and closed in place, chosen, lit, listed and saved."""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING

import pytest

from tests.browser_pages import OpenPage, expect, judge_with_axe, watch_pages
from tests.emit.site.conftest import write_bare_site
from tests.property_sizes import try_some
from tests.running import ROOT

if TYPE_CHECKING:
    from playwright.sync_api import Browser, Locator, Page

GROUP = ["Cleaning", "Controller", "Left Arm", "Localization", "Navigation", "Right Arm", "Smooth"]
LEFT_ARM = ["Elbow", "Planner", "Shoulder", "Watch"]


@pytest.fixture(scope="module")
def cleaning_robot(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Write the site of a robot with two arms of one type, without pictures."""
    return write_bare_site(ROOT / "examples" / "cleaning_robot", tmp_path_factory.mktemp("out") / "robot")


@pytest.fixture
def visit(browser: Browser, cleaning_robot: Path) -> Iterator[OpenPage]:
    """Open the explorer; an error or a message in the console is a failure."""
    with watch_pages(("file://", "data:")) as watch:

        def open_explorer(
            address: str = "", *, root: Path | None = None, path: str = "explorer.html", scheme: str = "light"
        ) -> Page:
            context = browser.new_context(
                viewport={"width": 1280, "height": 800},
                color_scheme=scheme,  # type: ignore[arg-type]
                reduced_motion="reduce",
            )
            page = watch(context.new_page())
            page.goto(f"file://{root or cleaning_robot}/{path}{address}")
            if path.startswith("explorer"):
                expect(page.locator(".stage .box").first).to_be_attached()
            return page

        yield open_explorer


def box(page: Page, title: str) -> Locator:
    """Find a box by its title."""
    return page.locator(".stage .box").filter(has=page.locator("title", has_text=re.compile(rf"^{re.escape(title)}\n")))


def titles(page: Page, kind: str = ".box") -> list[str]:
    """List the boxes by their titles."""
    return sorted(text.split("\n")[0] for text in page.locator(f".stage {kind} > title").all_text_contents())


def address(page: Page) -> dict[str, str]:
    """Give what stands in the address."""
    return page.evaluate("Object.fromEntries(new URLSearchParams(location.hash.slice(1)))")  # type: ignore[no-any-return]


def arrows(page: Page, kind: str = ".arrow") -> list[str]:
    """List the arrows by what is at their ends."""
    return sorted(text.split("\n")[0] for text in page.locator(f".map {kind} > title").all_text_contents())


def test_a_composed_component_opens_and_closes_in_place(visit: OpenPage) -> None:
    page = visit("#open=cleaning")
    assert titles(page) == GROUP
    before = box(page, "Navigation").bounding_box()
    box(page, "Left Arm").locator(".sign").click(force=True)
    expect(box(page, "Watch")).to_be_visible()
    assert titles(page) == sorted([*GROUP, *LEFT_ARM])
    assert address(page)["open"] == "cleaning cleaning.left_arm"
    assert box(page, "Navigation").bounding_box()["x"] == pytest.approx(before["x"], abs=1)  # type: ignore[index]
    page.go_back()
    expect(box(page, "Watch")).to_have_count(0)
    page.go_forward()
    box(page, "Left Arm").locator(".fold-sign").click()
    expect(box(page, "Watch")).to_have_count(0)
    assert titles(page) == GROUP


def test_an_address_opens_what_is_around_and_a_closed_group_closes_what_is_inside(visit: OpenPage) -> None:
    page = visit("#open=cleaning.left_arm")
    assert titles(page) == sorted([*GROUP, *LEFT_ARM])
    box(page, "Cleaning").locator(".fold-sign").click()
    expect(page.locator(".stage .box")).to_have_count(1)
    assert "open" not in address(page)
    box(page, "Cleaning").locator(".sign").click(force=True)
    expect(page.locator(".stage .box")).to_have_count(7)


def test_a_name_that_is_no_component_of_components_is_said(visit: OpenPage) -> None:
    page = visit("#open=cleaning.left_amr")
    assert page.locator(".notes").inner_text() == "cleaning.left_amr is not here; nearest: cleaning.left_arm."


def test_all_is_open_and_stands_inside_of_what_is_around_it_without_covering_anything(visit: OpenPage) -> None:
    page = visit("#open=cleaning")
    page.get_by_role("button", name="Close all").click()
    page.get_by_role("button", name="Open all").click()
    assert address(page)["open"] == "**"
    expect(page.locator(".stage .box")).to_have_count(18)
    wrong = page.evaluate("""() => {
      const places = [...document.querySelectorAll(".stage .box")].map((box) => ({ name: box.dataset.box, isOpen: Boolean(box.querySelector(".open")),
        at: box.querySelector(".shell").getBoundingClientRect() }));
      const holds = (a, b) => a.left <= b.left && a.right >= b.right && a.top <= b.top && a.bottom >= b.bottom;
      const meets = (a, b) => a.left < b.right - 1 && b.left < a.right - 1 && a.top < b.bottom - 1 && b.top < a.bottom - 1;
      return places.flatMap((one, at) => places.slice(at + 1).filter((other) => meets(one.at, other.at) &&
        !(one.isOpen && holds(one.at, other.at)) && !(other.isOpen && holds(other.at, one.at))).map((other) => [one.name, other.name]));
    }""")
    assert wrong == []


def test_what_runs_to_a_closed_one_runs_to_its_ports_and_to_an_open_one_to_what_stands_behind_them(
    visit: OpenPage,
) -> None:
    page = visit("#open=cleaning")
    assert {"Controller → Left Arm", "Left Arm → Controller"} <= set(arrows(page))
    page.locator(".map .arrow").filter(has_text="Left Arm → Controller").dispatch_event("click")
    assert page.locator(".panel .flows li").all_inner_texts() == ["Arm state\nLeft Arm · state → Controller · arms"]
    box(page, "Left Arm").locator(".sign").click(force=True)
    assert {"Controller → Left Arm · Planner", "Left Arm · Watch → Controller", "Shoulder → Watch"} <= set(arrows(page))
    assert "Left Arm → Controller" not in arrows(page)


def test_what_autoconnect_joined_is_dotted(visit: OpenPage) -> None:
    page = visit("#open=cleaning")
    assert arrows(page, ".arrow.made") == ["Navigation → Controller"]
    assert "joined by autoconnect" in page.locator(".legend").inner_text()
    box(page, "Localization").locator(".sign").click(force=True)
    assert arrows(page, ".arrow.made") == ["Gps → Pose Fusion", "Lidar → Pose Fusion", "Navigation → Controller"]


def test_the_panel_says_what_a_composed_component_is_made_of(visit: OpenPage) -> None:
    page = visit("#pick=cleaning.left_arm")
    panel = page.locator(".panel")
    assert panel.locator(".crumb").inner_text() == "Cleaning \u203a composed component"
    assert panel.locator(".ports").inner_text().split("\n")[:4] == [
        "in",
        "target Grasp",
        "from Controller · 10 Hz",
        "out",
    ]
    assert sorted(panel.locator(".columns .name").all_inner_texts()) == LEFT_ARM
    assert "See And Grasp" in panel.inner_text()
    panel.get_by_role("button", name="Watch").click()
    assert panel.locator(".crumb").inner_text() == "Cleaning \u203a Left Arm \u203a component"
    expect(box(page, "Watch")).to_be_visible()


def test_a_focus_inside_lights_what_is_in_there_and_the_frames_around(visit: OpenPage) -> None:
    page = visit("#pick=cleaning.left_arm.watch")
    page.get_by_role("button", name="Focus").click()
    assert address(page)["sel"] == "1+cleaning.left_arm.watch+1"
    assert titles(page, ".box.lit") == ["Cleaning", "Controller", "Elbow", "Left Arm", "Shoulder", "Watch"]
    assert arrows(page, ".arrow.lit.before") == ["Elbow → Watch", "Shoulder → Watch"]
    assert arrows(page, ".arrow.lit.after") == ["Left Arm · Watch → Controller"]
    box(page, "Left Arm").locator(".fold-sign").click()
    assert titles(page, ".box.lit") == ["Cleaning", "Controller", "Left Arm"]


@pytest.mark.parametrize(
    ("selector", "lit"),
    [
        ("left_arm.**", ["Cleaning", "Left Arm"]),
        ("is:motor", ["Cleaning", "Left Arm", "Right Arm"]),
        ("is:filter", ["Cleaning", "Smooth"]),
        ("localization..smooth", ["Cleaning", "Localization", "Smooth"]),
    ],
)
def test_selectors_light_closed_boxes_of_what_they_name_inside(visit: OpenPage, selector: str, lit: list[str]) -> None:
    page = visit("#open=cleaning")
    page.locator("#selector").fill(selector)
    page.keyboard.press("Enter")
    assert titles(page, ".box.lit") == lit


def test_filters_and_colours_reach_inside(visit: OpenPage) -> None:
    page = visit("#open=cleaning&only=type:Joint+target&colour=period")
    assert titles(page) == ["Cleaning", "Left Arm", "Right Arm"]
    assert "3 of 4" in box(page, "Left Arm").locator(".line").text_content()  # type: ignore[operator]
    assert box(page, "Left Arm").locator(".stripe").count() >= 1


def test_keys_open_and_close_what_is_composed(visit: OpenPage) -> None:
    page = visit("#open=cleaning")
    box(page, "Left Arm").focus()
    box(page, "Left Arm").press("Enter")
    page.keyboard.press("Escape")
    box(page, "Left Arm").focus()
    page.keyboard.press("o")
    assert address(page)["open"] == "cleaning cleaning.left_arm"
    assert page.evaluate("document.activeElement.querySelector('title').textContent").startswith("Left Arm\n")
    page.keyboard.press("ArrowDown")
    inner = page.evaluate("document.activeElement.querySelector('title').textContent.split('\\n')[0]")
    assert inner in LEFT_ARM
    page.keyboard.press("o")
    assert address(page)["open"] == "cleaning"


def test_the_list_has_what_is_inside_and_opens_it(visit: OpenPage) -> None:
    page = visit("#open=cleaning&view=list")
    page.get_by_role("button", name="Open Left Arm").click()
    names = page.locator(".as-list li > span:first-child > .name").all_inner_texts()
    assert sorted(names) == sorted([*GROUP, *LEFT_ARM])
    inner = page.locator(".as-list li", has=page.get_by_role("button", name="Close Left Arm")).last
    assert "Watch" in inner.inner_text()
    watch = page.locator(".as-list li", has=page.get_by_role("button", name="Watch", exact=True)).last
    assert watch.inner_text().split("\n")[1:3] == [
        "takes from Shoulder (1 flow), Elbow (1 flow)",
        "gives to Controller (1 flow)",
    ]
    controller = page.locator(".as-list li", has_text="gives to Left Arm · Planner (1 flow)").last
    assert controller.inner_text() == "gives to Left Arm · Planner (1 flow), Right Arm (1 flow)"
    page.get_by_role("button", name="Close Left Arm").click()
    assert address(page)["open"] == "cleaning"


@pytest.mark.parametrize(
    ("path", "opened"),
    [
        ("components/cleaning.left_arm.html", {"pick": "cleaning.left_arm"}),
        ("components/cleaning.left_arm.elbow.html", {"pick": "cleaning.left_arm.elbow"}),
        ("component_types/motor.html", {"sel": "is:motor"}),
    ],
)
def test_pages_lead_to_the_map(visit: OpenPage, path: str, opened: dict[str, str]) -> None:
    page = visit(path=path)
    page.get_by_role("link", name="Show in explorer").click()
    expect(page.locator(".stage .box").first).to_be_attached()
    assert address(page) == {"level": "components", **opened}
    if "pick" in opened:
        page.get_by_role("link", name="Open page").click()
        assert page.url.endswith(path)


def test_a_saved_picture_has_what_is_open(visit: OpenPage, tmp_path: Path) -> None:
    page = visit("#open=cleaning.left_arm")
    page.get_by_role("button", name="Share").click()
    with page.expect_download() as download:
        page.get_by_role("button", name="Save as SVG").click()
    download.value.save_as(tmp_path / "map.svg")
    text = (tmp_path / "map.svg").read_text("utf-8")
    assert ">Shoulder</text>" in text
    assert ">Lidar</text>" not in text
    assert 'stroke-linecap="round"' in text


@pytest.mark.parametrize("scheme", try_some(["light", "dark"]))
@pytest.mark.parametrize("hash_", ["#open=cleaning.left_arm&pick=cleaning.left_arm", "#open=**&view=list"])
def test_axe_finds_nothing(visit: OpenPage, scheme: str, hash_: str) -> None:
    assert judge_with_axe(visit(hash_, scheme=scheme)) == []


@pytest.fixture(scope="module")
def nested(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Write the site of 4 groups of 5 machines of 3 modules of 4 cells."""
    folder = tmp_path_factory.mktemp("nested")
    machines = "".join(f"      m{at}: {{is: machine}}\n" for at in range(5))
    groups = "".join(f"  g{at}:\n    components:\n{machines}" for at in range(4))
    (folder / "robot.yaml").write_text(
        "archgen: 1\nproject: {id: r, title: R}\ncomponent_types:\n  cell: {inputs: {i: T}, outputs: {o: T}}\n"
        "  module:\n    components:\n      a: {is: cell}\n      b: {is: cell, inputs: {i: a.o}}\n      c: {is: cell, inputs: {i: a.o}}\n"
        "      d: {inputs: {i: [b.o, c.o]}}\n  machine: {components: {x: {is: module}, y: {is: module}, z: {is: module}}}\n"
        f"groups:\n{groups}",
        "utf-8",
    )
    return write_bare_site(folder / "robot.yaml", folder / "site")


def test_above_the_budget_what_is_composed_folds_and_what_is_chosen_is_shown(visit: OpenPage, nested: Path) -> None:
    page = visit("#open=**&pick=g3.m4.z.c", root=nested)
    assert page.locator(".stage .box").count() <= 150
    expect(page.locator(".stage .box.picked")).to_have_count(1)
    assert (
        page.locator(".stage .box.lit").count() == 6
    )  # what feeds it, what it feeds, itself, and the frames around it
    assert re.search(r"^\d+ composed components folded, \d+ components\.", page.locator(".notes").inner_text())
    name = page.locator(".notes button").first.inner_text()
    page.locator(".notes button").first.click()
    expect(page.locator(".stage .box:has(.open)").filter(has_text=name.split(" · ")[-1]).first).to_be_visible()
    page.get_by_role("button", name="Show all", exact=True).click()
    expect(page.locator(".stage .box")).to_have_count(4 + 20 + 60 + 240)


ROUTE = """boxes => {
  const [tail, head] = boxes;
  const arrow = { id: "a", tail, head, meeting: { home: null, tail, head } };
  const bounds = { left: 0, right: 400, top: 0, bottom: 440, columns: [boxes] };
  archgenExplorer.routeArrows({ boxes, arrows: [arrow] }, bounds);
  return [arrow.start[0], arrow.stop[0], arrow.direction, bounds.left < 0, bounds.right > 100];
}"""


def test_a_line_past_something_wide_in_its_column_runs_at_the_left(visit: OpenPage) -> None:
    page = visit()

    def route(width: int) -> object:
        sizes = ((100, 0, 40), (100, 400, 40), (width, 100, 200))
        boxes = [
            {"id": str(at), "x": 0, "columnX": 0, "columnWidth": width, "width": wide, "y": y, "height": high}
            for at, (wide, y, high) in enumerate(sizes)
        ]
        return page.evaluate(ROUTE, boxes)

    assert route(400) == [0, 0, 1, True, True]
    assert route(100) == [100, 100, -1, False, True]


def test_no_arrow_turns_back_on_its_way_past_frames(visit: OpenPage, tmp_path: Path) -> None:
    machine = (
        "      m{at}:\n        inputs: {{i: {source}}}\n        outputs: {{o: {{from: z.o}}}}\n        components:\n"
        "          x: {{is: module, inputs: {{i: self.i}}}}\n          y: {{is: module, inputs: {{i: x.o}}}}\n"
        "          z: {{is: module, inputs: {{i: y.o}}}}\n"
    )
    groups = ""
    for group in range(5):
        sources = [f"g{group - 1}.m{at}.o" if group else "{external: World}" for at in range(3)]
        groups += f"  g{group}:\n    components:\n" + "".join(
            machine.format(at=at, source=source) for at, source in enumerate(sources)
        )
    (tmp_path / "robot.yaml").write_text(
        "archgen: 1\nproject: {id: r, title: R}\ncomponent_types:\n  cell: {inputs: {i: T}, outputs: {o: T}}\n"
        "  module:\n    inputs: {i: T}\n    outputs: {o: {from: b.o}}\n    components:\n"
        f"      a: {{is: cell, inputs: {{i: self.i}}}}\n      b: {{is: cell, inputs: {{i: a.o}}}}\ngroups:\n{groups}",
        "utf-8",
    )
    site = write_bare_site(tmp_path / "robot.yaml", tmp_path / "site")
    page = visit("#open=**&full=1", root=site)
    assert page.locator(".map .arrow").count() > 80
    # A way round the outside has corners (Q); any other goes one way only.
    turned = page.evaluate("""() => [...document.querySelectorAll(".map .arrow .way")].map((way) => way.getAttribute("d"))
      .filter((path) => !path.includes("Q"))
      .filter((path) => {
        const ends = path.match(/[MCL][^MCL]+/g).map((piece) => Number(piece.slice(1).trim().split(" ").at(-2)));
        const steps = ends.slice(1).map((x, at) => x - ends[at]).filter((step) => Math.abs(step) > 1);
        return steps.some((step) => Math.sign(step) !== Math.sign(steps[0]));
      })""")
    assert turned == []


def test_a_small_architecture_is_open_at_first_and_stays_closed_when_somebody_closed_it(visit: OpenPage) -> None:
    page = visit()
    assert titles(page) == sorted(GROUP)
    assert address(page) == {}
    page.get_by_role("button", name="Close all").click()
    expect(page.locator(".stage .box")).to_have_count(1)
    assert address(page) == {"level": "components"}
    page.go_back()
    expect(page.locator(".stage .box")).to_have_count(len(GROUP))
