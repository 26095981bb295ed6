"""What is kept between two starts: settings, recent files, autosaves; and that nothing unsaved is lost."""
