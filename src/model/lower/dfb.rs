//! The interface of a DFB type.

use rustc_hash::FxHashMap;
use smol_str::SmolStr;

use super::builder::Builder;
use super::pl7::Pl7;
use crate::model::dfb::{Interface, Item, ItemType, Role};
use crate::model::entity::Entity;
use crate::model::object::{Area, Class, Footprint, Object, Rights, Type};
use crate::model::symbols::{Remark, RemarkKind, key};
use crate::syntax::{SyntaxKind, SyntaxNode};

/// The items of the interface by their key.
pub(super) type Items = FxHashMap<SmolStr, ItemType>;

/// Reads the interface of a DFB type, if the unit is one, so that its names are known in the code.
pub(super) fn enter(pl7: &mut Pl7, root: SyntaxNode<'_>) {
    if !matches!(pl7.b.model.entity, Entity::Dfb { .. }) {
        return;
    }
    let mut interface = Interface::default();
    for section in root.children().filter(|it| it.kind() == SyntaxKind::VarSection) {
        let word = section.tokens().find(|it| it.kind() == SyntaxKind::Ident);
        let Some(role) = word.and_then(|it| Role::of_section(it.text())) else { continue };
        for it in section.children().filter(|it| it.kind() == SyntaxKind::VarDecl) {
            declaration(&mut pl7.b, &mut interface, role, it);
        }
        remarks(&mut pl7.b, section);
    }
    let heading = root.children().find(|it| it.kind() == SyntaxKind::Heading);
    let name = heading.and_then(|it| it.tokens().filter(|it| it.kind() == SyntaxKind::Ident).nth(1));
    interface.anchor = name.map_or(0, |it| pl7.b.anchor(it.text_range()));
    for it in &interface.items {
        pl7.items.entry(key(&it.name)).or_insert(it.ty);
    }
    pl7.b.model.interface = Some(Box::new(interface));
}

fn declaration(b: &mut Builder, interface: &mut Interface, role: Role, node: SyntaxNode<'_>) {
    let child = |kind| node.children().find(|it| it.kind() == kind);
    let joined = |it: SyntaxNode<'_>| -> SmolStr {
        let tokens = it.descendant_tokens().filter(|it| !it.kind().is_trivia());
        tokens.map(|it| it.text()).collect::<String>().into()
    };
    let ty = child(SyntaxKind::TypeRef);
    let ty_anchor = ty.map(|it| b.anchor(it.text_range()));
    let initial = child(SyntaxKind::InitValue).map(|it| (joined(it), b.anchor(it.text_range())));
    let kind = ty.map_or(ItemType::Unknown, |it| ItemType::parse(&joined(it)));
    for name in node.children().filter(|it| it.kind() == SyntaxKind::VarName) {
        let anchor = b.anchor(name.text_range());
        interface.items.push(Item {
            name: name.text().into_owned().trim().into(),
            role,
            ty: kind,
            initial: initial.clone(),
            anchor,
            ty_anchor: ty_anchor.unwrap_or(anchor),
        });
    }
}

/// Comments of the items: in a declaration, or behind it on its line.
fn remarks(b: &mut Builder, section: SyntaxNode<'_>) {
    let mut declarations = section.children().filter(|it| it.kind() == SyntaxKind::VarDecl).map(|it| it.text_range());
    let mut next = declarations.next();
    let mut is_behind = false;
    for token in section.descendant_tokens() {
        let range = token.text_range();
        while next.is_some_and(|it| it.end() <= range.start()) {
            next = declarations.next();
        }
        let is_inside = next.is_some_and(|it| it.contains_range(range));
        match token.kind() {
            SyntaxKind::Newline => is_behind = false,
            SyntaxKind::Comment if is_inside || is_behind => {
                b.model.remarks.push(Remark::new(RemarkKind::Item, token.text(), range));
            }
            kind if !kind.is_trivia() => is_behind = is_inside,
            _ => {}
        }
    }
}

/// What a name in the code is, when the interface has it: `Raz`, `Tab`, `Mot:X3`. Its own, and no other unit's.
pub(super) fn object(items: &Items, path: &str, is_indexed: bool) -> Option<Object> {
    if items.is_empty() {
        return None;
    }
    let end = path.find(':').unwrap_or(path.len());
    let (name, rest) = path.split_at_checked(end)?;
    let name = key(name);
    let item = *items.get(&name)?;
    let ty = match rest.strip_prefix(':') {
        _ if is_indexed => item.element(),
        Some(bit) if bit.starts_with(['X', 'x']) => Type::Bool,
        Some(_) => Type::Unknown,
        None => item.to_type(),
    };
    Some(Object {
        text: path.into(),
        class: Class::LocalName,
        ty,
        footprint: footprint(name, rest),
        rights: Rights::Unknown,
        extracted: false,
        indexed: is_indexed,
    })
}

/// The bits of one item overlap with those of that item alone.
fn footprint(name: SmolStr, rest: &str) -> Footprint {
    const WHOLE: u32 = 32;
    let bit = rest.strip_prefix([':']).and_then(|it| it.strip_prefix(['X', 'x'])).and_then(|it| it.parse::<u32>().ok());
    match bit.filter(|it| *it < WHOLE) {
        Some(bit) => Footprint::new(Area::LocalName(name), bit, 1),
        None => Footprint::new(Area::LocalName(name), 0, WHOLE),
    }
}
