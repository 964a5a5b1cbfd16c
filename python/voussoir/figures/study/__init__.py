"""Figures, numbers and sentences over several tunnels, as the paper compares covers and soils: see README.md above."""
