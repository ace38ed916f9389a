"""What is made one by one for a reader who waits is what is made all together for a site."""

from __future__ import annotations

from dataclasses import replace
from functools import cache
from pathlib import Path
from typing import get_args

import pytest

from archgen.pipeline import CheckedProject, check_project
from archgen.products import project_views
from archgen.products.output_options import OutputOptions
from archgen.views.agreement.exchange_tables import gather_exchanges
from archgen.views.drawings_on_demand import DrawingsOnDemand
from archgen.views.pages import partner_pages, site_pages
from archgen.views.pages.report_outline import DetailLevel
from archgen.views.pages.single_page import make_page_at
from tests.property_sizes import try_some

PROJECTS = Path(__file__).parents[2]
LEVELS = get_args(DetailLevel)


@cache
def _check(name: str) -> CheckedProject:
    return check_project(PROJECTS / name)


@pytest.mark.parametrize("level", LEVELS)
@pytest.mark.parametrize("name", try_some(["examples/first_robot", "example_ramcip"]))
def test_each_drawing_is_the_one_of_the_whole_set(name: str, level: DetailLevel) -> None:
    views = project_views.make_views(_check(name), OutputOptions(level=level, show_history=False))
    names = list(views.drawings)
    # The last ones first, each from a set of its own kind: none may need another to be made before.
    on_demand = DrawingsOnDemand(views.lookup, level)
    assert {drawing_id: on_demand[drawing_id] for drawing_id in reversed(names)} == views.drawings
    assert list(on_demand) == names
    assert len(on_demand) == len(names)


@pytest.mark.parametrize("level", LEVELS)
def test_what_no_project_draws_is_not_there(level: DetailLevel) -> None:
    views = project_views.make_views(_check("example_ramcip"), OutputOptions(level=level, show_history=False))
    on_demand = DrawingsOnDemand(views.lookup, level)
    ids = ("", "/", "x", "groups", "groups/x", "components/x", "implementation/x", "views/x", "timing/x", "chains/x")
    assert [name for name in ids if name in on_demand] == []
    if level == "functional":
        assert [name for name in ("ros", "hosts", "timing", "load") if name in on_demand] == []


@pytest.mark.parametrize("level", LEVELS)
@pytest.mark.parametrize("name", ["examples/first_robot", pytest.param("example_ramcip", marks=pytest.mark.slow)])
def test_each_page_is_the_one_of_the_whole_site(name: str, level: DetailLevel, monkeypatch: pytest.MonkeyPatch) -> None:
    views = project_views.make_views(_check(name), OutputOptions(level=level, show_history=False))
    exchanges = gather_exchanges(views.lookup)
    # Else they would be gathered again for each of the hundred pages on partners.
    monkeypatch.setattr(partner_pages, "gather_exchanges", lambda _lookup: exchanges)
    pages = site_pages.make_pages(views.lookup, views.edition)
    edition = replace(views.edition, drawings=DrawingsOnDemand(views.lookup, level))
    for page in pages:
        single_page = make_page_at(views.lookup, edition, page.anchor)
        # Two requirements may have names that give one path: the numbers behind it take all pages to know.
        assert single_page is not None, page.anchor
        assert replace(single_page, path=page.path) == page
    assert make_page_at(views.lookup, edition, "component:nobody.here") is None
    assert make_page_at(views.lookup, edition, "nonsense") is None
