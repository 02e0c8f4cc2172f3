//! Data that families of commands keep in a session.

use std::any::{Any, TypeId};
use std::collections::HashMap;

/// One value of each type, made when it is first asked for.
#[derive(Default)]
pub(crate) struct Extensions(HashMap<TypeId, Box<dyn Any>>);

impl Extensions {
    /// The value of this type.
    pub(crate) fn get<T: Default + 'static>(&mut self) -> &mut T {
        let boxed = self.0.entry(TypeId::of::<T>()).or_insert_with(|| Box::<T>::default());
        match boxed.downcast_mut() {
            Some(data) => data,
            None => unreachable!("the key is the type of the data"),
        }
    }
}
