//! What a shell did to the command line before the program saw it.

/// A hint where the shell has cut a list at its blanks: an argument that opens more square brackets than it closes.
pub(super) fn unquoted_list(arguments: impl Iterator<Item = String>) -> Option<String> {
    let arguments: Vec<String> = arguments.collect();
    let opened = |text: &str| text.matches('[').count() as i64 - text.matches(']').count() as i64;
    let begin = arguments.iter().position(|text| text.contains("=[") && opened(text) > 0)?;
    let mut depth = 0;
    let rest = arguments[begin..].iter().position(|text| {
        depth += opened(text);
        depth <= 0
    });
    let whole = arguments[begin..=begin + rest?].join(" ");
    Some(format!("the shell has cut a list at its blanks; quote it: '{}'", whole.replace('\'', "'\\''")))
}

#[cfg(test)]
mod tests {
    use super::unquoted_list;

    fn hint(line: &str) -> Option<String> {
        unquoted_list(line.split(' ').map(str::to_owned))
    }

    #[test]
    fn a_list_that_the_shell_has_cut_is_shown_whole_and_quoted() {
        let said = hint("sweep heap --vary particles.restitution=[0.9, 0.7, 0.5] --replicas 3").unwrap();
        assert!(said.ends_with("quote it: 'particles.restitution=[0.9, 0.7, 0.5]'"), "{said}");
        let said = hint("run heap --set initial.x=[[1, 2], [3, 4]]").unwrap();
        assert!(said.ends_with("'initial.x=[[1, 2], [3, 4]]'"), "{said}");
        assert_eq!(hint("sweep heap --vary particles.restitution=[0.9,0.7] extra"), None);
        assert_eq!(hint("sweep heap --vary particles.restitution=[0.9 extra"), None);
    }
}
