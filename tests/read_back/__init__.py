"""Every file that jointid reads back, each with a valid example, and what may stand in it instead."""
