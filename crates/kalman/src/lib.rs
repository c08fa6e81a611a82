//! Kalman filters in linear, extended, unscented, square-root, information and switching forms.
