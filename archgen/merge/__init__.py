"""Three versions become one: slices merged by the ids of what they hold, and open branches before git merges them."""
