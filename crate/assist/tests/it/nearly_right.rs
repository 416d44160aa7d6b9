//! Texts that are nearly right, and what must hold for all texts: the checks of the fuzzer.

use fuzzer::{check, generate};
use rats::compile;
use trials::trials;

#[test]
fn any_nearly_right_text() {
    trials(|u| {
        let text = generate::dataset(u)?;
        let project = check::project(&text, "sphere m0 1 0 0 0\n");
        let compiled = compile(&project);
        let byte = u.int_in_range(0..=text.len() + 2)?;
        let sound = check::result(&project, &compiled)
            .and_then(|()| check::help(&project, &compiled, byte))
            .and_then(|()| check::unrun(&text))
            .and_then(|()| check::repeats(&project, &compiled))
            .and_then(|()| check::layout(&project, &compiled))
            .and_then(|()| check::sharing(&project));
        assert_eq!(sound, Ok(()), "{text}");
        Ok(())
    })
    .cases(300);
}

#[test]
fn any_content_of_a_link() {
    trials(|u| {
        let bytes: Vec<u8> = u.arbitrary()?;
        let sound = check::link(&String::from_utf8_lossy(&bytes))
            .and_then(|()| check::link_content(&bytes));
        assert_eq!(sound, Ok(()));
        Ok(())
    })
    .cases(600);
}
