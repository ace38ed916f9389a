"""What happens to a loaded project until its findings stand: merged, linked, judged, in each variant, behind each pass."""
