//! The page itself: one file with its style and script, that loads nothing from anywhere.

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use serde_json::{Value, json};
use sha2::{Digest, Sha256};

use super::log::ViewedLog;
use crate::report::colour::ColourMap;
use crate::report::escape::{escape, escape_json};

/// Colours of a map.
const SHADES: usize = 64;
/// Where fields end: the light end of their map would not be seen on paper.
const FIELD_END: f64 = 0.9;

/// The parts of the script, those that others use first.
const SCRIPTS: [&str; 9] = [
    include_str!("page/number.js"),
    include_str!("page/source.js"),
    include_str!("page/store.js"),
    include_str!("page/camera.js"),
    include_str!("page/paint_gl.js"),
    include_str!("page/paint_flat.js"),
    include_str!("page/plots.js"),
    include_str!("page/pane.js"),
    include_str!("page/player.js"),
];

/// Where the frames are.
pub(super) enum Contents {
    /// The server has them.
    Served,
    /// They stand in the page: what is known of the logs, and the bytes of each.
    Embedded(Value, Vec<Vec<u8>>),
}

/// The page of `logs`.
pub(super) fn html(logs: &[ViewedLog], contents: &Contents) -> String {
    let mut titles: Vec<&str> = logs.iter().map(ViewedLog::title).collect();
    titles.dedup();
    let title = escape(&titles.join(" and "));
    let version = logs.first().map_or("", ViewedLog::version);
    let (policy, about, data) = match contents {
        Contents::Served => (String::new(), "null".to_owned(), String::new()),
        Contents::Embedded(about, packs) => {
            let policy = policy(false);
            let policy = format!("<meta http-equiv=\"Content-Security-Policy\" content=\"{policy}\">\n");
            let pack = |(index, bytes): (usize, &Vec<u8>)| {
                let text = STANDARD.encode(bytes);
                format!("<script type=\"text/plain\" id=\"data-{index}\">{text}</script>\n")
            };
            let data = packs.iter().enumerate().map(pack).collect();
            (policy, escape_json(&about.to_string()), data)
        }
    };
    format!(
        include_str!("page/view.html"),
        policy = policy,
        title = title,
        style = style(),
        script = script(),
        about = about,
        data = data,
        footer = escape(&format!("Recorded by grainflow {version}.")),
    )
}

/// What the page may do: run its own script, use its own style, and, where it is `served`, ask its own server.
pub(super) fn policy(served: bool) -> String {
    let hash = |text: &str| STANDARD.encode(Sha256::digest(text.as_bytes()));
    let (connect, frames) = if served { ("'self'", "; frame-ancestors 'none'") } else { ("'none'", "") };
    format!(
        "default-src 'none'; script-src 'sha256-{}'; style-src 'sha256-{}'; img-src data:; connect-src {connect}; \
         base-uri 'none'; form-action 'none'{frames}",
        hash(&script()),
        hash(&style()),
    )
}

/// Maps of colours that the page may use.
pub(super) fn colours() -> Value {
    let shades = |map: ColourMap, end: f64| -> Vec<String> {
        (0..SHADES).map(|k| map.hexadecimal(end * k as f64 / (SHADES - 1) as f64)).collect()
    };
    json!({ "speed": shades(ColourMap::Speed, 1.0), "field": shades(ColourMap::Field, FIELD_END) })
}

fn style() -> String {
    format!("\n{}{}", include_str!("../report/page.css"), include_str!("page/view.css"))
}

fn script() -> String {
    format!("\n(function () {{\n\"use strict\";\n{}}})();\n", SCRIPTS.concat())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_page_asks_nobody_and_nothing_can_end_its_script() {
        let page = html(&[], &Contents::Served);
        for foreign in ["http://", "https://", "@import", "src=", " style=\"", "onclick", "eval("] {
            assert!(!page.contains(foreign), "{foreign}");
        }
        assert!(!script().contains("</") && !style().contains("</"));
        assert!(page.contains(&format!("<script>{}</script>", script())));
        assert!(page.contains(&format!("<style>{}</style>", style())));
    }

    #[test]
    fn the_policy_names_hashes_and_no_wildcards() {
        let policy = policy(true);
        assert!(policy.starts_with("default-src 'none'; script-src 'sha256-"), "{policy}");
        assert!(!policy.contains("unsafe") && !policy.contains('*') && !policy.contains('"'));
    }
}
