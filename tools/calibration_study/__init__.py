"""Rolling resistance and thickness searched for the study's three soils at once."""
