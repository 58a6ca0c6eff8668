//! Pictures of what shadow volumes do: overlays and figures.
