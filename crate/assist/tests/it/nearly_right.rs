//! Texts that are nearly right, and what must hold for all texts: the fuzzer's checks, for a few seconds.

#[path = "../../examples/fuzz/check.rs"]
mod checks;
#[path = "../../examples/fuzz/generate.rs"]
mod generate;

use rats::compile;
use trials::trials;

#[test]
fn any_nearly_right_text() {
    trials(|u| {
        let text = generate::dataset(u)?;
        let project = checks::project(&text, "sphere m0 1 0 0 0\n");
        let compiled = compile(&project);
        let byte = u.int_in_range(0..=text.len() + 2)?;
        let sound = checks::compiled(&project, &compiled)
            .and_then(|()| checks::helped(&project, &compiled, byte))
            .and_then(|()| checks::unrun(&text))
            .and_then(|()| checks::repeats(&project, &compiled))
            .and_then(|()| checks::laid_out(&project, &compiled))
            .and_then(|()| checks::sent(&project));
        assert_eq!(sound, Ok(()), "{text}");
        Ok(())
    })
    .cases(1_000);
}

#[test]
fn any_content_of_a_link() {
    trials(|u| {
        let bytes: Vec<u8> = u.arbitrary()?;
        let sound = checks::link(&String::from_utf8_lossy(&bytes))
            .and_then(|()| checks::link_content(&bytes));
        assert_eq!(sound, Ok(()));
        Ok(())
    })
    .cases(600);
}
