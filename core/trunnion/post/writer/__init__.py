"""From motions to the text of a control in word-address format: what all dialects of that kind share."""
