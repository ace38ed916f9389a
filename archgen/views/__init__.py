"""Views: the model and its analyses, as the four plain shapes that emitters draw."""
