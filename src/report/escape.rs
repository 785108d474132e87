//! Text made safe for HTML and SVG.

/// `text` with the five characters that mean something to HTML replaced by entities.
pub(crate) fn escape(text: &str) -> String {
    let mut safe = String::with_capacity(text.len());
    for character in text.chars() {
        match character {
            '&' => safe.push_str("&amp;"),
            '<' => safe.push_str("&lt;"),
            '>' => safe.push_str("&gt;"),
            '"' => safe.push_str("&quot;"),
            '\'' => safe.push_str("&#39;"),
            // Control characters are not allowed in a document at all.
            c if c.is_control() && !matches!(c, '\n' | '\t') => safe.push('\u{fffd}'),
            c => safe.push(c),
        }
    }
    safe
}

/// JSON text made safe for the inside of a `<script>` element: no `<` can end it.
pub(crate) fn escape_json(json: &str) -> String {
    json.replace('<', "\\u003c")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn markup_becomes_text() {
        assert_eq!(escape("<script>\"a\" & 'b'"), "&lt;script&gt;&quot;a&quot; &amp; &#39;b&#39;");
        assert_eq!(escape("ν = 0.1\u{7}"), "ν = 0.1\u{fffd}");
    }

    #[test]
    fn a_script_cannot_be_ended_by_its_data() {
        assert!(!escape_json("{\"t\":\"</script>\"}").contains("</"));
    }
}
