"""Figures of a run from its HDF5 files, in soil mechanics' signs; one module per kind of figure."""
