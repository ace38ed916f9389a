"""What only the printed report has: blocks put together so that a component takes a page, its front matter, its annexes."""
