//! The programs at the end of the tutorials, as tests.

macro_rules! tutorials {
    ($($name:ident $page:literal)*) => {$(
        #[doc = include_str!(concat!("../../../docs/tutorials/", $page))]
        struct $name;
    )*};
}

tutorials! {
    Slam "slam.md"
    Lines "lines.md"
    Color "color.md"
    Views "views.md"
    Track "track.md"
    Cml "cml.md"
}
