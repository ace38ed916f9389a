"""Views: turn the model and its analyses into the plain shapes that emitters draw."""
