"""The look of the window: colours and what they mean, themes, icons, and how numbers and kinds read."""
