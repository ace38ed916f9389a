"""What the tests of pictures share: layouts use the font that ships, as they do in the workers."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

from archgen.emit.graphviz import font_config


@pytest.fixture(autouse=True, scope="session")
def shipped_font(tmp_path_factory: pytest.TempPathFactory) -> Path:
    file = font_config.write_font_config(tmp_path_factory.mktemp("fonts"))
    os.environ["FONTCONFIG_FILE"] = str(file)
    return file
