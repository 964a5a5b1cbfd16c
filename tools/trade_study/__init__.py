"""A study of what each knob of the grain engine costs and buys."""
