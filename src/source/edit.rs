//! Where two texts differ.

/// The place of an edit that makes one text of another, by the old one's offsets: where it starts and where it ends.
pub(crate) fn difference(old: &str, new: &str) -> (usize, usize) {
    let (old, new) = (old.as_bytes(), new.as_bytes());
    let start = common_start(old, new);
    (start, old.len() - common_end(&old[start..], &new[start..]))
}

/// Number of bytes that two texts begin with, in strides that the processor compares at once.
fn common_start(a: &[u8], b: &[u8]) -> usize {
    const STRIDE: usize = 256;
    let strides = a.chunks_exact(STRIDE).zip(b.chunks_exact(STRIDE)).take_while(|it| it.0 == it.1).count();
    let at = strides * STRIDE;
    at + a[at..].iter().zip(&b[at..]).take_while(|it| it.0 == it.1).count()
}

/// Number of bytes that two texts end with.
fn common_end(a: &[u8], b: &[u8]) -> usize {
    const STRIDE: usize = 256;
    let strides = a.rchunks_exact(STRIDE).zip(b.rchunks_exact(STRIDE)).take_while(|it| it.0 == it.1).count();
    let (a, b) = (&a[..a.len() - strides * STRIDE], &b[..b.len() - strides * STRIDE]);
    strides * STRIDE + a.iter().rev().zip(b.iter().rev()).take_while(|it| it.0 == it.1).count()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn edits_have_a_place() {
        assert_eq!(difference("abc", "abc"), (3, 3));
        assert_eq!(difference("abc", "abxc"), (2, 2));
        assert_eq!(difference("aaa", "aa"), (2, 3));
        assert_eq!(difference("", "x"), (0, 0));
        let long = "L     MW 10\n".repeat(100);
        let edited = format!("{}X{}", &long[..700], &long[701..]);
        assert_eq!(difference(&long, &edited), (700, 701));
    }
}
