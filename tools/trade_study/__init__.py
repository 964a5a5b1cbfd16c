"""What each knob of the grain engine costs and buys."""
