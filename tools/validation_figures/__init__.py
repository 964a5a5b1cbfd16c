"""The pictures of docs/validation."""
