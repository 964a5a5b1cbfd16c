"""What moves the trends of the study that are not seen. See README.md."""
