"""PowerPoint: the sections of an outline as slides of 16:9. `write_slides` is all that others need.

python-pptx is an extra: without it there is a `PythonPptxError`. Only `slide_drawing` knows it.
"""

from __future__ import annotations

from collections.abc import Mapping

from archgen.emit.office_package import sign_package
from archgen.emit.picture import Picture
from archgen.emit.pptx.slide_flow import flow_section
from archgen.emit.template_package import TemplateError
from archgen.views.shapes import Outline


class PythonPptxError(Exception):
    """The library that writes slides is not installed; the text says how to get it."""


def write_slides(outline: Outline, pictures: Mapping[str, Picture], template: bytes | None = None) -> bytes:
    """Return the slides of an outline: a first one, then one for each section, more where a section is long.

    Raise TemplateError, with a message for the user, if the template cannot be used.
    """
    try:
        from archgen.emit.pptx.slide_drawing import SlideDrawing
    except ImportError:
        raise PythonPptxError("writing .pptx needs the library python-pptx: `pip install python-pptx`") from None

    def draw(used_template: bytes | None) -> bytes:
        drawing = SlideDrawing(outline, used_template)
        for section in outline.sections:
            sheets = flow_section(section, pictures)
            for number, sheet in enumerate(sheets, start=1):
                drawing.add_slide(section.title, f"{number} of {len(sheets)}" if len(sheets) > 1 else "", sheet)
        return sign_package(drawing.save())

    try:
        return draw(template)
    except TemplateError:
        raise
    # What python-pptx raises at damaged parts, whenever it comes to them; it has no error of its own for most.
    except (LookupError, ValueError, AttributeError, TypeError, ArithmeticError, RuntimeError) as error:
        if template is None:
            raise
        draw(None)  # where the template is not to blame, the same error comes again
        message = f"the template is no PowerPoint file (.pptx or .potx), or it is damaged ({error})"
        raise TemplateError(message) from None
