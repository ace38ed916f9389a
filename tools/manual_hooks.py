"""What MkDocs is told of the manual: `mkdocs.yml` names this file, and `make docs` runs it."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

ROOT = Path(__file__).resolve().parents[1]
REPOSITORY = "https://github.com/archgen/archgen/blob/main/"
_OUTER_LINK = re.compile(r"\]\((?:\.\./)+([^)\s]*)\)")
_LISTED = re.compile(r"^\| \[([^\]]+)\]\(([^)]+)\)", re.MULTILINE)


def make_anchor(heading: str, separator: str) -> str:
    """Return the anchor of a heading as GitHub makes it, so that one link leads to it in both places."""
    return re.sub(r"[^\w\- ]", "", heading.strip().lower()).replace(" ", separator)


def list_navigation(index: str, docs: Path) -> list[dict[str, Any]]:
    """Return what docs/index.md lists: the sections with their pages; a folder stands for its pages."""
    navigation: list[dict[str, Any]] = [{"The manual": "index.md"}]
    for section in re.split(r"^## ", index, flags=re.MULTILINE)[1:]:
        title, _, text = section.partition("\n")
        entries: list[Any] = []
        for name, target in _LISTED.findall(text):
            folder = docs / (target.removesuffix("README.md") if target.endswith("/README.md") else target)
            pages = sorted(page.relative_to(docs).as_posix() for page in folder.glob("*.md")) if folder.is_dir() else []
            first = [page for page in pages if page.endswith("README.md")]
            entries.append({name: [*first, *(page for page in pages if page not in first)] if pages else target})
        navigation.append({title.strip(): entries})
    return navigation


def on_config(config: Any) -> Any:  # noqa: ANN401 - MkDocs' own
    """Take navigation and anchors as the pages have them."""
    docs = Path(config["docs_dir"])
    config["nav"] = list_navigation((docs / "index.md").read_text(encoding="utf-8"), docs)
    config["mdx_configs"].setdefault("toc", {}).update(slugify=make_anchor, permalink=True)
    return config


def on_page_markdown(markdown: str, page: Any, **_others: object) -> str:  # noqa: ANN401 - MkDocs' own
    """Let links that leave the manual lead to the repository, and those to folders to their pages."""
    del page
    inner = markdown.replace("](decisions)", "](decisions/0001-no-networkx.md)")
    return _OUTER_LINK.sub(lambda match: match[0] if _stays(match[1]) else f"]({REPOSITORY}{match[1]})", inner)


def on_post_build(config: Any) -> None:  # noqa: ANN401 - MkDocs' own
    """Write what programs that read for somebody look for: each page with what it is for."""
    index = (Path(config["docs_dir"]) / "index.md").read_text(encoding="utf-8")
    (Path(config["site_dir"]) / "llms.txt").write_text(
        write_contents(index, config["site_description"]), encoding="utf-8"
    )


def write_contents(index: str, description: str) -> str:
    """Return the manual's contents as `llms.txt` has them: a title, a summary, sections with links to pages."""
    lines = ["# archgen", "", f"> {description}"]
    for section in re.split(r"^## ", index, flags=re.MULTILINE)[1:]:
        lines += ["", f"## {section.partition(chr(10))[0].strip()}", ""]
        for name, target, purpose in re.findall(r"^\| \[([^\]]+)\]\(([^)]+)\) \| (.*) \|$", section, re.MULTILINE):
            page = "decisions/0001-no-networkx.html" if target == "decisions" else target.removesuffix(".md") + ".html"
            lines.append(f"- [{name}]({page.replace('README.html', 'index.html')}): {purpose}")
    return "\n".join(lines) + "\n"


def _stays(target: str) -> bool:
    return (ROOT / "docs" / target.partition("#")[0]).exists()
