"""What decides the result of a tunnel, and by how much: runs, results and tables."""
