"""The pages of the documents as a site of files: what becomes a page, how it is drawn, and what is checked."""
