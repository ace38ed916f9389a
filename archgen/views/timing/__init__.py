"""What timing says, as blocks, tables and charts."""
