"""The pages of the site and the outline of the report."""
